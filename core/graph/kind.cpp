#include "core/graph/kind.hpp"

#include <algorithm>
#include <cassert>

#include "core/light/light_op.hpp"
#include "core/light/renderer.hpp"

namespace lightnet {
namespace {

bool by_name(const Kind& a, const Kind& b) { return a.name < b.name; }

Kind scene_kind() {
    Kind kind;
    kind.name = "Scene";
    kind.role = Role::scene;
    kind.help = "what is seen: Scene { \"file.pbrt\" }, the file named from the graph's folder";
    return kind;
}

}  // namespace

Registry::Registry(std::vector<Kind> kinds) : kinds_(std::move(kinds)) {
    kinds_.push_back(scene_kind());
    std::sort(kinds_.begin(), kinds_.end(), by_name);
    assert(std::adjacent_find(kinds_.begin(), kinds_.end(),
                              [](const Kind& a, const Kind& b) { return a.name == b.name; }) == kinds_.end() &&
           "each kind has a name of its own");
}

const Kind* Registry::find(std::string_view name) const {
    const auto at = std::find_if(kinds_.begin(), kinds_.end(), [&](const Kind& kind) { return kind.name == name; });
    return at == kinds_.end() ? nullptr : &*at;
}

std::string_view to_string(Role role) {
    switch (role) {
        case Role::light:
            return "light";
        case Role::image:
            return "image";
        case Role::scene:
            return "scene";
    }
    return "";
}

std::string_view to_string(ParamType type) {
    switch (type) {
        case ParamType::number:
            return "number";
        case ParamType::integer:
            return "integer";
        case ParamType::flag:
            return "flag";
        case ParamType::text:
            return "text";
        case ParamType::numbers:
            return "numbers";
        case ParamType::film:
            return "film";
        case ParamType::scene:
            return "scene";
    }
    return "";
}

}  // namespace lightnet
