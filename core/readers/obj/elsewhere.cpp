#include "core/readers/obj/elsewhere.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace lightnet::obj {
namespace {

/// Where else it may be. All of them are files.
std::vector<std::string> other_places(const std::string& from, const std::string& written, Assets& assets) {
    const std::string alone = beside(from, written.substr(written.find_last_of('/') + 1));
    std::vector<std::string> places;
    // read at once, so that hosts are sent what was found, and find it again
    const auto add = [&](const std::string& path) {
        if (assets.exists(path)) places.push_back(path);
    };
    if (const auto found = assets.like(written)) add(*found);
    add(alone);
    if (const auto found = assets.like(alone)) add(*found);
    return places;
}

std::string written_by(const std::string& from, std::string name) {
    std::ranges::replace(name, '\\', '/');
    return beside(from, name);
}

}  // namespace

std::optional<std::string> find_library(const std::string& from, const std::string& name, const SourceLine& where,
                                        Assets& assets) {
    if (name.empty()) return std::nullopt;
    const std::string written = written_by(from, name);
    if (assets.exists(written)) return written;
    const auto others = other_places(from, written, assets);
    if (others.empty()) return std::nullopt;
    assets.report().warn(where, fmt::format("there is no material library '{}': '{}' is taken", name, others[0]));
    return others[0];
}

std::shared_ptr<const Image> find_picture(const std::string& from, const std::string& name, const Encoding& encoding,
                                          const SourceLine& where, const std::string& instead, Assets& assets) {
    const std::string written = written_by(from, name);
    const Assets::Picture first = assets.try_picture(written, encoding);
    if (first.image) return first.image;
    const auto warn = [&](const std::string& done) {
        assets.report().warn(where, fmt::format("image '{}': {}: {}", written, first.problem, done));
    };
    for (const std::string& place : other_places(from, written, assets))
        if (const auto& other = assets.try_picture(place, encoding).image) {
            warn("'" + place + "' is taken");
            return other;
        }
    warn(instead);
    return nullptr;
}

}  // namespace lightnet::obj
