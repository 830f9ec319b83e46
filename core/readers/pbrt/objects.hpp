// Objects of a pbrt file, and their instances.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "core/base/math/transform.hpp"
#include "core/readers/pbrt/graphics_state.hpp"
#include "core/readers/pbrt/shapes.hpp"
#include "core/readers/pbrt/sources.hpp"
#include "core/readers/pbrt/syntax.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// Those of a scene, by name. Looks at what it is made of while it lives.
class Objects {
public:
    Objects(const Sources& sources, SceneData& scene, Blocks& blocks)
        : sources_(sources), scene_(scene), blocks_(blocks) {}

    void begin(const Statement& statement);
    void end(const Statement& statement);
    /// An import that ends may have left one open.
    void abandon() { open_ = std::nullopt; }
    /// The object that shapes are for now.
    const std::optional<std::uint32_t>& open() const { return open_; }
    void place(const Statement& statement, const Matrix& placed, Budget& budget);

private:
    const Sources& sources_;
    SceneData& scene_;
    Blocks& blocks_;
    std::map<std::string, std::uint32_t> objects_;
    std::optional<std::uint32_t> open_;
};

}  // namespace lightnet::pbrt
