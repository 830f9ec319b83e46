// glTF's animations: what stands elsewhere at another time.
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/readers/gltf/document.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::gltf {

/// Which of the animations is wanted, and when.
struct Moment {
    std::optional<std::string> animation{};  // by its name, or number from 1 on; *: all; none: the first
    std::optional<double> seconds{};  // none: all stands as the file has it, or, of a named one, at its beginning
};

/// All of a file, and how long each takes.
std::vector<SceneAnimation> animations_of(Document& document);

/// Makes the document say what it would if all stood as at that moment: nodes (translation, rotation, scale), weights
/// of morph targets, and what KHR_animation_pointer points at. Before the first key and after the last all stands
/// still. To be called before anybody reads nodes. Throws UserError when there is no such animation. Nodes whose morph
/// targets it moves, at whatever time.
std::set<std::size_t> move_to(const Moment& moment, Document& document);

}  // namespace lightnet::gltf
