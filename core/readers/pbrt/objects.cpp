#include "core/readers/pbrt/objects.hpp"

#include <fmt/format.h>

#include <vector>

#include "core/base/suggestion.hpp"
#include "core/readers/pbrt/transforms.hpp"
#include "core/scene/surfaces/placement.hpp"

namespace lightnet::pbrt {

void Objects::begin(const Statement& s) {
    if (open_) {
        sources_.report.error(s.where, "ObjectBegin inside of another object");
        return;
    }
    blocks_.begin(Blocks::Kind::object, s.where);
    const auto [place, fresh] = objects_.try_emplace(s.names[0], static_cast<std::uint32_t>(scene_.objects.size()));
    if (fresh)
        scene_.objects.push_back({s.names[0], {}});
    else
        sources_.report.error(s.where, fmt::format("there is an object '{}' already", s.names[0]));
    open_ = place->second;
}

void Objects::end(const Statement& s) {
    if (blocks_.end(Blocks::Kind::object, "ObjectBegin", s.where)) open_ = std::nullopt;
}

void Objects::place(const Statement& s, const Matrix& placed, Budget& budget) {
    constexpr std::uint64_t size = 16;  // in memory, beside a vertex's
    const auto found = objects_.find(s.names[0]);
    const bool singular = !inverse(placed);
    if (singular && found != objects_.end() && !open_)
        return sources_.report.warn(s.where, "an instance stands under a singular transform, and is left out");
    const std::string fault = singular ? "" : lightnet::Placement::fault(placed);
    if (found != objects_.end() && !open_ && fault.empty()) {
        budget.take(size);
        if (!budget.exceeded()) scene_.instances.push_back({found->second, placed});
        return;
    }
    std::vector<std::string> known;
    for (const auto& [name, object] : objects_) known.push_back(name);
    sources_.report.error(s.where, open_                     ? "ObjectInstance inside of an object"
                                   : found == objects_.end() ? fmt::format("there is no object '{}'{}", s.names[0],
                                                                           did_you_mean(s.names[0], known))
                                                             : fault);
}

}  // namespace lightnet::pbrt
