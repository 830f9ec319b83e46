// Parts of the geometry of an OBJ file.
#pragma once

#include <string>

#include "core/base/error.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::obj {

/// Faces of one material and one object. Shading normals are as in the file, or empty.
struct Part {
    Mesh mesh;
    std::string material;  // "": the file names none
    bool smooth = false;   // a smoothing group is on
    SourceLine where;
    std::string object{};  // "": the file names none
};

/// Somebody's wish that objects of a name are subdivided.
struct Subdivision {
    std::string object;  // its name, * for any part of one
    int levels = 0;
};

}  // namespace lightnet::obj
