// Names of lamps, and the groups into which they are sorted.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Lamps that a user can't tell apart by name, as one.
struct NamedLamp {
    std::vector<std::string> names;  // it goes by any of them; the first is how it is called
    std::string what;                // "shape", "spot", "point", "sun", "environment"
    std::size_t count = 1;
    std::uint32_t group = 0;  // index into SceneData::groups
};

/// All lamps of a scene: shapes that shine in the order of the file, then lights without a shape, then what is around
/// the scene, which is one lamp called `environment`. A shape goes by the name of its emitter, by its own and by that
/// of its material. What has no name is called by what it is: lamp, spot, point, sun; the second one spot2, and so on.
std::vector<NamedLamp> lamps_of(const SceneData& scene);

/// By shape: the first name of the lamp that it is; "": it is none.
std::vector<std::string> lamp_names_of_shapes(const SceneData& scene);

/// All lamps that go by one name, or are of its form.
struct LampsCalled {
    std::vector<std::size_t> shapes, lights;  // indices into those of SceneData
    bool around = false;                      // what is around the scene is one of them
    std::string another;  // the name of the first that has a shape, or is around the scene; "": none is
    std::string fault;    // what is wrong where there are none at all; else ""
};
LampsCalled lamps_called(const SceneData& scene, const std::string& wanted);

/// Lamps whose light is kept apart, or looked for alone.
struct LampGroup {
    std::string name;
    std::vector<std::string> lamps;  // names, * for any part of one
};

/// Sorts all lamps into these groups, behind which comes `rest`. Returns what is wrong, one sentence each: a name that
/// no lamp has, a group without a lamp, a lamp in two groups.
std::vector<std::string> sort_lamps(SceneData& scene, const std::vector<LampGroup>& groups);

/// Is the name the one that is asked for, or of its form ("chair*")?
bool goes_by(const std::string& name, const std::string& wanted);

}  // namespace lightnet
