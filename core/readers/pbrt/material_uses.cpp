#include "core/readers/pbrt/material_uses.hpp"

#include <fmt/format.h>

#include "core/base/suggestion.hpp"

namespace lightnet::pbrt {

MaterialUses::MaterialUses(const Sources& sources, SceneData& scene, Material unless_named)
    : sources_(sources), scene_(scene) {
    use(std::move(unless_named), {});
}

MaterialId MaterialUses::add(Material material) {
    scene_.materials.push_back(std::move(material));
    return static_cast<MaterialId>(scene_.materials.size() - 1);
}

std::size_t MaterialUses::use(Material material, const SourceLine& where) {
    uses_.push_back({add(std::move(material)), "", where});
    return uses_.size() - 1;
}

std::size_t MaterialUses::use(const std::string& name, const SourceLine& where) {
    const auto [place, fresh] = named_.try_emplace(name, uses_.size());
    if (fresh) uses_.push_back({std::nullopt, name, where});
    return place->second;
}

void MaterialUses::make(std::size_t use, Material material) { uses_[use].made = add(std::move(material)); }

std::optional<MaterialId> MaterialUses::made(const std::string& name) const {
    const auto found = named_.find(name);
    return found == named_.end() ? std::nullopt : made(found->second);
}

void MaterialUses::check() const {
    std::vector<std::string> known;
    for (const auto& [name, use] : named_)
        if (uses_[use].made) known.push_back(name);
    for (const auto& use : uses_) {
        if (use.made || sources_.report.full()) continue;
        sources_.report.error(use.first,
                              fmt::format("there is no material '{}'{}", use.name, did_you_mean(use.name, known)));
    }
}

}  // namespace lightnet::pbrt
