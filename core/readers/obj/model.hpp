// The geometry of OBJ files.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/readers/common/report.hpp"
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

struct Library {
    std::string name;  // or several
    SourceLine where;
};

struct Model {
    std::vector<Part> parts;  // without empty ones, in the order of their first faces
    std::vector<Library> libraries;
};

/// What the parts are cut by.
enum class Cut { by_material, nowhere };

/// Reads v, vn, vt, f with indices from both ends, g, o, s, usemtl and mtllib; polygons are cut into triangles. What is
/// wrong is reported with its line and left out.
Model read_model(std::span<const std::byte> bytes, const std::string& file, Cut cut, Report& report);

}  // namespace lightnet::obj
