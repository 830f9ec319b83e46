// Notes in the file of a picture, beside its pixels.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "core/film/film.hpp"
#include "core/film/picture.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/data/surface_names.hpp"

namespace lightnet {

/// What is said of a picture, and of the names in its mattes.
struct PictureWords {
    PictureNotes notes;
    std::map<std::string, std::string> manifests;  // by matte
};

/// The camera (worldToCamera, worldToNDC: scene units), software, seed, graph (a hash of what its pixels follow from,
/// as in picture_recipe()) and groups of lamps. Nothing of when, where or by whom it was made. `scene`: as it is
/// rendered.
PictureWords words_of(const Graph& graph, const Registry& registry, const FilmFormat& format,
                      const std::map<std::string, std::string>& recipe, const SceneData& scene,
                      const CameraData& seen_from);

/// A matte's names and their ids (name_id(), 8 hexadecimal digits): JSON in ASCII, sorted by name, as the specification
/// of Cryptomatte has it. What is not UTF-8 in a name is replaced.
std::string manifest_of(const SceneData& scene, NamedBy by);

/// Puts them into a picture.
void add_words(const PictureWords& words, Picture& picture);

/// The note of a picture that says how many samples its pixels have, an attribute of its file.
inline constexpr const char* samples_note = "samples";
/// What it says; none: it is not there, or no number.
std::optional<std::uint32_t> noted_samples(const Picture& picture);

}  // namespace lightnet
