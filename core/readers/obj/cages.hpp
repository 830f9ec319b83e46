// Objects of OBJ files that are subdivided.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/readers/common/report.hpp"
#include "core/readers/common/subdivided.hpp"
#include "core/readers/obj/lines.hpp"
#include "core/readers/obj/part.hpp"

namespace lightnet::obj {

/// Where a file's lists stand for a corner of a face.
struct Corner {
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    std::uint32_t position = none, uv = none, normal = none;
    friend bool operator==(const Corner&, const Corner&) = default;
};

/// Tags that mean something here. A file with one of them is a cage.
inline constexpr std::array<std::string_view, 6> known_tags{
    "crease", "corner", "hole", "interpolateboundary", "facevaryinginterpolateboundary", "creasemethod"};

/// A face of three corners or more, and what holds where it stands.
struct CageFace {
    std::span<const Corner> corners;
    std::size_t number = 0;  // from 0 on, in the file
    const std::string& object;
    const std::string& material;
    SourceLine where;
};

/// Keeps faces of objects that are subdivided, until the file has said all about them: as tags, the lines `t` by which
/// OpenSubdiv's own examples tell of creases, corners, holes, borders, and that the file is a cage at all.
class Cages {
public:
    /// `tagged`: the file has such lines, so that objects that `wanted` doesn't name are subdivided, too.
    Cages(const std::vector<Subdivision>& wanted, bool tagged);

    /// How often an object is subdivided. 0: it has faces as they are.
    int levels(const std::string& object);
    void add(const CageFace& face, Report& report);
    /// What stands behind the `t` of a line.
    void tag(Lines& lines, Report& report);
    /// Of all objects, by materials. What is wrong is reported.
    std::vector<Part> finish(const Mesh& lists, const std::string& file, Report& report);

private:
    struct Object {
        int levels = 0;
        std::vector<std::uint32_t> sizes, part_of;  // by face
        std::vector<std::size_t> numbers;
        std::vector<Corner> corners;
        std::vector<Part> parts;
    };
    struct Edge {
        std::size_t a = 0, b = 0;
        float sharpness = 0;
        SourceLine where;
    };
    struct Tip {
        std::size_t vertex = 0;
        float sharpness = 0;
    };

    bool numbers_of(Lines& lines, std::vector<std::size_t>& whole, std::vector<float>& sharp, Report& report) const;
    Cage cage_of(const Object& object, const Mesh& lists);
    void add_creases(const std::map<std::uint32_t, std::uint32_t>& vertices, Cage& cage);

    const std::vector<Subdivision>& wanted_;
    const bool tagged_;
    std::map<std::string, Object> objects_;
    std::vector<Edge> creases_;
    std::vector<bool> found_;  // of these
    std::vector<Tip> tips_;
    std::set<std::size_t> holes_;
    std::set<std::string> named_;  // of what is wanted, what is there
    std::set<std::string> seen_;   // objects
    Cage rules_;                   // without faces
};

}  // namespace lightnet::obj
