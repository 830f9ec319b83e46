#include "core/readers/obj/elsewhere.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace lightnet::obj {
namespace {

/// Some exporters put names in quotes.
std::string written_by(const std::string& from, std::string name) {
    if (name.size() > 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
    std::ranges::replace(name, '\\', '/');
    return beside(from, name);
}

std::optional<std::string> find(std::string_view what, const std::string& from, const std::string& name,
                                const SourceLine& where, Assets& assets) {
    if (name.empty()) return std::nullopt;
    const std::string written = written_by(from, name);
    if (assets.exists(written)) return written;
    const auto others = assets.other_places(from, written);
    if (others.empty()) return std::nullopt;
    assets.report().warn(where, fmt::format("there is no {} '{}': '{}' is taken", what, name, others[0]));
    return others[0];
}

}  // namespace

std::optional<std::string> find_library(const std::string& from, const std::string& name, const SourceLine& where,
                                        Assets& assets) {
    return find("material library", from, name, where, assets);
}

std::optional<std::string> find_curve(const std::string& from, const std::string& name, const SourceLine& where,
                                      Assets& assets) {
    return find("spectral curve", from, name, where, assets);
}

std::shared_ptr<const Image> find_picture(const std::string& from, const std::string& name, const Encoding& encoding,
                                          const SourceLine& where, const std::string& instead, Assets& assets) {
    const std::string written = written_by(from, name);
    const Assets::Picture first = assets.try_picture(written, encoding);
    const auto remark_on = [&](const std::string& place, const Assets::Picture& found) {
        if (!found.remark.empty()) assets.report().warn(where, fmt::format("image '{}': {}", place, found.remark));
        return found.image;
    };
    if (first.image) return remark_on(written, first);
    const auto warn = [&](const std::string& done) {
        assets.report().warn(where, fmt::format("image '{}': {}: {}", written, first.problem, done));
    };
    for (const std::string& place : assets.other_places(from, written))
        if (const Assets::Picture& other = assets.try_picture(place, encoding); other.image) {
            warn("'" + place + "' is taken");
            return remark_on(place, other);
        }
    warn(instead);
    return nullptr;
}

}  // namespace lightnet::obj
