// The identity of a scene, to the light in it.
#pragma once

#include <map>
#include <vector>

#include "core/base/hash.hpp"
#include "core/base/lamp_groups.hpp"
#include "core/base/scene_parts.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Names what light meets in a scene: surfaces, where they stand, what they are made of and covered with, and what
/// shines. Camera, film, names and the places of files don't count: another view of a room is the same room.
Hash identity_of(const SceneData& scene);

/// A scene as a tree of hashes. Where one is as it was, so is what it names, and all that follows from that alone.
struct SceneTree {
    std::vector<Hash> textures, materials, shapes, instances;  // of each, in the scene's order
    std::vector<Hash> lamps;                                   // by group: all that shines, environments included
    std::map<ScenePart, Hash> parts;  // each with what it hangs on: holes of a shape on textures, lamps on shapes

    /// Of some parts together, of lamps those of these groups. Throws Error where it has not all of them.
    Hash of(SceneParts some, GroupSet groups = all_groups) const;
    /// Adds the camera and the film: those that are used.
    void look_by(const CameraData& camera, const FilmData& film);
};

/// All but camera and film.
SceneTree tree_of(const SceneData& scene);

}  // namespace lightnet
