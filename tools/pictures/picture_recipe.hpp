// The recipe of a picture, in names and values.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "core/film/film.hpp"
#include "core/network/graph/kind.hpp"
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

}  // namespace lightnet
