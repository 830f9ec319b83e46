// The geometry of OBJ files.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/readers/common/report.hpp"
#include "core/readers/obj/part.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::obj {

struct Library {
    std::string name;  // or several
    SourceLine where;
};

struct Model {
    std::vector<Part> parts;  // without empty ones, in the order of their first faces
    std::vector<Library> libraries;
};

/// What the parts are cut by; where nothing, tags of subdivision have no meaning.
enum class Cut { by_material, nowhere };

/// Reads v, vn, vt, f with indices from both ends, g, o, s, usemtl, mtllib and tags of subdivision (t); polygons are
/// cut into triangles, or objects subdivided where the file or somebody says so. What is wrong is reported with its
/// line and left out.
Model read_model(std::span<const std::byte> bytes, const std::string& file, Cut cut, Report& report,
                 const std::vector<Subdivision>& subdivided = {});

}  // namespace lightnet::obj
