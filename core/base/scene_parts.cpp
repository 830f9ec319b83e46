#include "core/base/scene_parts.hpp"

#include "core/base/error.hpp"

namespace lightnet {

std::string to_string(ScenePart part) {
    switch (part) {
        case ScenePart::camera:
            return "camera";
        case ScenePart::film:
            return "film";
        case ScenePart::geometry:
            return "geometry";
        case ScenePart::materials:
            return "materials";
        case ScenePart::lamps:
            return "lamps";
        case ScenePart::media:
            return "media";
        case ScenePart::names:
            return "names";
    }
    return "";
}

std::string to_string(SceneParts parts) {
    if (parts == SceneParts()) return "nothing";
    if (parts == whole_scene) return "everything";
    std::string text;
    for (const ScenePart part : all_scene_parts)
        if (parts.contain(part)) text += (text.empty() ? "" : ", ") + to_string(part);
    return text;
}

void SceneParts::refuse(SceneParts read) const {
    SceneParts missing;
    for (const ScenePart part : all_scene_parts)
        if (read.contain(part) && !contain(part)) missing |= part;
    throw Error("scene", "it reads " + to_string(missing) + ", and its kind declares that it reads " +
                             to_string(*this) + ": name " + to_string(missing) + " in the kind's 'reads', too");
}

}  // namespace lightnet
