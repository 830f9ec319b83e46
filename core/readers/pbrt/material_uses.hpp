// Materials of a pbrt file by their names, some of which are used before they are made.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/readers/pbrt/sources.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// Which material a use means is known at the end of the file. The first use is of the material that holds where none
/// is named.
class MaterialUses {
public:
    MaterialUses(const Sources& sources, SceneData& scene, Material unless_named);

    /// Of a material without a name.
    std::size_t use(Material material, const SourceLine& where);
    /// Of the material that has that name now, or will have it.
    std::size_t use(const std::string& name, const SourceLine& where);
    /// The material of a use: the scene's next.
    void make(std::size_t use, Material material);
    /// It can't be made, which has been said: the first material stands for it.
    void give_up(std::size_t use) { uses_[use].made = 0; }
    /// From here on the name means another material.
    void forget(const std::string& name) { named_.erase(name); }

    /// None: not yet.
    std::optional<MaterialId> made(std::size_t use) const { return uses_[use].made; }
    std::optional<MaterialId> made(const std::string& name) const;
    /// At the end: reports what was used and never made.
    void check() const;

private:
    struct Use {
        std::optional<MaterialId> made;
        std::string name;
        SourceLine first;
    };
    MaterialId add(Material material);

    const Sources& sources_;
    SceneData& scene_;
    std::vector<Use> uses_;
    std::map<std::string, std::size_t> named_;  // index into uses_
};

}  // namespace lightnet::pbrt
