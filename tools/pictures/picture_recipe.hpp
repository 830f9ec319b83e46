// The recipe of a picture, in names and values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/film/film.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/graph/single_lights.hpp"
#include "core/run/assembly/job.hpp"

namespace lightnet {

/// All that the picture of a job depends on, beside the number of its samples, for checkpoints ("seed" → "7"). `tile`
/// doesn't change it, but a film is cut in one way.
std::map<std::string, std::string> picture_recipe(const Job& job, const Registry& registry, const FilmFormat& format,
                                                  std::uint32_t tile);

/// All that the film of a job depends on, beside the number of its samples: the parts of the scene that its nodes read,
/// wherever they come from, and nothing of exposure, gains, files or what is done with the film afterwards.
std::map<std::string, std::string> film_recipe(const Job& job, const Registry& registry, const FilmFormat& format,
                                               std::uint32_t tile, const MadeFrom& made_from);

/// Colours of a film that one node's light makes, and all that they depend on, beside the number of its samples.
struct LightRecipe {
    SingleLight light;
    std::vector<std::size_t> colours;  // of the film: its layers, and the halves of these
    std::map<std::string, std::string> recipe;
};
/// Those of the film of a job. None where nobody has looked into its scene, or where there are fewer than two.
std::vector<LightRecipe> light_recipes(const Job& job, const Registry& registry, const FilmFormat& format,
                                       std::uint32_t tile, const MadeFrom& made_from);

}  // namespace lightnet
