// glTF's lights: KHR_lights_punctual and EXT_lights_ies.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "core/readers/common/lamp_tilt.hpp"
#include "core/readers/gltf/document.hpp"

namespace lightnet::gltf {

/// Adds to a scene the lights that stand at its nodes.
class Lights {
public:
    Lights(Document& document, Assets& assets) : document_(document), assets_(assets) {}

    /// Those that a node names, where it stands. They go by the name of the node, or else by their own.
    void add(const At& node, const Matrix& to_world);

private:
    void punctual(const At& index, const Matrix& to_world, const std::string& node);
    void luminaire(const At& named, const Matrix& to_world, const std::string& node);
    struct Luminaire {
        EnvironmentData pattern;
        LampTilt tilt;
    };
    const Luminaire* pattern(std::size_t index, const At& profile);

    Document& document_;
    Assets& assets_;
    std::map<std::size_t, std::optional<Luminaire>> patterns_;  // by profile; none: reported
};

}  // namespace lightnet::gltf
