#include "core/readers/obj/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "core/base/unwanted.hpp"
#include "core/readers/common/mesh_tools.hpp"
#include "core/readers/obj/cages.hpp"
#include "core/readers/obj/lines.hpp"
#include "core/scene/reach.hpp"

namespace lightnet::obj {
namespace {

float from_srgb(float value) { return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f); }

/// Statements that say what programs show of curves, and how they draw.
bool has_no_effect(std::string_view word) {
    constexpr std::string_view words[] = {"lod", "bevel",      "c_interp",  "d_interp",
                                          "mg",  "shadow_obj", "trace_obj", "maplib"};
    return std::ranges::find(words, word) != std::end(words);
}

/// Colours of vertices in a file of which some are above 1.
void decode(Part& part, Report& report) {
    if (part.mesh.colours.empty()) return;
    report.warn(part.where, "colours of vertices above 1 are taken as parts of 255, as sRGB");
    for (Rgb& colour : part.mesh.colours)
        colour = {from_srgb(colour.r / 255), from_srgb(colour.g / 255), from_srgb(colour.b / 255)};
}

constexpr std::uint32_t none = Corner::none;

struct Mix {
    std::size_t operator()(const Corner& c) const {
        std::uint64_t h = c.position * 0x9E3779B97F4A7C15ull;
        h = (h ^ (h >> 29) ^ c.uv) * 0xBF58476D1CE4E5B9ull;
        h = (h ^ (h >> 32) ^ c.normal) * 0x94D049BB133111EBull;
        return h ^ (h >> 31);
    }
};

/// How many there are of each: indices below 0 count from there.
struct Counts {
    std::size_t positions = 0, uvs = 0, normals = 0;
};

/// Reads corners of faces: "v", "v/vt", "v//vn" or "v/vt/vn".
class CornerReader {
public:
    /// `so_far`: where the face stands; `all`: what can be named. `last`: nothing comes later.
    CornerReader(const Counts& so_far, const Counts& all, bool last, const Lines& lines, Report& report)
        : so_far_(so_far), all_(all), last_(last), lines_(lines), report_(report) {}

    /// None: it names what comes later, or it was reported.
    std::optional<Corner> read(std::string_view text) {
        const auto part = [&] {
            const auto end = std::min(text.find('/'), text.size());
            const auto digits = text.substr(0, end);
            text.remove_prefix(std::min(end + 1, text.size()));
            return digits;
        };
        Corner corner;
        const auto position = vertex(part());
        if (!position) return std::nullopt;
        corner.position = *position;
        if (const auto digits = part(); !digits.empty())
            corner.uv = index_or_none(digits, so_far_.uvs, all_.uvs, "texture coordinates");
        if (const auto digits = part(); !digits.empty())
            corner.normal = index_or_none(digits, so_far_.normals, all_.normals, "normals");
        return names_later_ ? std::nullopt : std::optional(corner);
    }
    /// Some corner has named what isn't there, yet or at all.
    bool names_later() const { return names_later_; }

private:
    /// None: reported.
    std::optional<std::int64_t> whole(std::string_view digits) {
        std::int64_t value = 0;
        const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (problem == std::errc{} && end == digits.data() + digits.size()) return value;
        report_.error(lines_.where(), fmt::format("an index expected, not '{}'", digits.substr(0, 32)));
        return std::nullopt;
    }

    /// Of "7", or of "-1" from the `count`-th on. None: there is no such one among `all`, yet or at all.
    std::optional<std::uint32_t> place(std::int64_t value, std::size_t count, std::size_t all) {
        const auto before = static_cast<std::int64_t>(count), size = static_cast<std::int64_t>(all);
        const bool there = value != 0 && value <= size && value >= -before;
        names_later_ = names_later_ || (!there && !last_);
        if (!there) return std::nullopt;
        return static_cast<std::uint32_t>(value > 0 ? value - 1 : before + value);
    }

    /// None: it comes later, or it was reported.
    std::optional<std::uint32_t> vertex(std::string_view digits) {
        const auto value = whole(digits);
        const auto found = value ? place(*value, so_far_.positions, all_.positions) : std::nullopt;
        if (value && !found && !names_later_)
            report_.error(lines_.where(),
                          fmt::format("index {} is out of range: there are {} vertices", *value, all_.positions));
        return found;
    }

    /// A face is there without them, too.
    std::uint32_t index_or_none(std::string_view digits, std::size_t count, std::size_t all, const char* of) {
        const auto value = whole(digits);
        const auto found = value ? place(*value, count, all) : std::nullopt;
        if (value && !found && !names_later_)
            report_.warn(lines_.where(), fmt::format("faces name {} that are not there, and go without", of));
        return found.value_or(none);
    }

    const Counts so_far_, all_;
    const bool last_;
    const Lines& lines_;  // of which one has the face
    Report& report_;
    bool names_later_ = false;
};

/// Does a line begin with a known tag of subdivision?
bool has_tags(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return std::ranges::any_of(known_tags, [&](auto tag) { return text.find("\nt " + std::string(tag)) != text.npos; });
}

class ModelReader {
public:
    ModelReader(std::span<const std::byte> bytes, const std::string& file, Cut cut, Report& report,
                const std::vector<Subdivision>& subdivided)
        : lines_(bytes, file),
          cut_(cut),
          report_(report),
          cages_(subdivided, cut == Cut::by_material && has_tags(bytes)) {}

    Model read() {
        while (!report_.full() && lines_.next()) {
            end_if_unwanted();
            statement(lines_.word());
        }
        finish_waiting();
        Model model;
        for (auto& part : parts_)
            if (!part.part.mesh.triangles.empty()) model.parts.push_back(finished(std::move(part)));
        for (Part& part : cages_.finish(lists_, lines_.where().file, report_)) model.parts.push_back(std::move(part));
        if (std::ranges::any_of(lists_.colours, [](Rgb colour) { return max_component(colour) > 1; }))
            for (Part& part : model.parts) decode(part, report_);
        model.libraries = std::move(libraries_);
        return model;
    }

private:
    using Key = std::tuple<std::string, std::string, bool>;  // object, material, smooth
    struct Open {
        Part part;
        std::unordered_map<Corner, std::uint32_t, Mix> vertices;
        bool normals = false, uvs = false, subdivided = false;
    };
    /// A face of vertices that come later, and what held where it stands.
    struct Waiting {
        std::size_t number = 0;  // of the face
        std::string words;
        SourceLine where;
        std::string object, material;
        bool smooth = false;
        Counts counts;
    };

    void statement(std::string_view word) {
        if (word == "v") return vertex();
        if (word == "vn") return normal();
        if (word == "vt") return uv();
        if (word == "f" || word == "fo") return face(faces_++, counts(), false);
        if (word == "usemtl") return use_material();
        if (word == "mtllib") return libraries_.push_back({std::string(trimmed(lines_.rest(), "\"")), lines_.where()});
        if (word == "s") return smooth();
        if (word == "o") return object();
        if (word == "t" && cut_ == Cut::by_material) return cages_.tag(lines_, report_);
        if (word == "g" || word == "vp" || has_no_effect(word)) return;
        if (word == "l" || word == "p")
            report_.warn(lines_.where(), "lines and points have no surface and are left out");
        else
            report_.warn(
                lines_.where(),
                fmt::format("unknown statement '{}' is left out: the picture shows nothing of it", word.substr(0, 32)));
    }

    /// Three numbers. None: reported.
    std::optional<Vec3> triple(const char* what) {
        const auto x = lines_.number(report_), y = x ? lines_.number(report_) : x, z = y ? lines_.number(report_) : y;
        if (z) return Vec3{*x, *y, *z};
        report_.error(lines_.where(), fmt::format("{} needs three numbers", what));
        return std::nullopt;
    }

    void vertex() {
        lists_.positions.push_back(triple("a vertex").value_or(Vec3{}));
        if (!in_reach(lists_.positions.back())) report_.error(lines_.where(), "the vertex lies out of reach");
        std::vector<float> more;
        while (const auto value = lines_.number(report_)) more.push_back(*value);
        // "x y z", "x y z w" with a weight of curves, "x y z r g b", "x y z r g b a"
        const auto left_out = [&](const char* what) {
            report_.warn(lines_.where(), fmt::format("{} is left out: the picture shows nothing of it", what));
        };
        if (more.size() == 2 || more.size() > 4) left_out("what stands behind the position of a vertex");
        if (more.size() == 4 && more[3] != 1) left_out("the alpha of a vertex");
        if (more.size() != 3 && more.size() != 4) return;
        if (lists_.colours.size() + 1 == lists_.positions.size())
            lists_.colours.push_back({more[0], more[1], more[2]});
        else
            left_out("the colour of a vertex behind others that have none");
    }

    void normal() { lists_.normals.push_back(triple("a normal").value_or(Vec3{})); }

    void uv() {
        const auto u = lines_.number(report_), v = u ? lines_.number(report_) : u;
        if (!u) report_.error(lines_.where(), "a texture coordinate needs a number");
        lists_.uvs.push_back({u.value_or(0), v.value_or(0)});
    }

    void smooth() {
        const auto group = lines_.word();
        smooth_ = group != "off" && group != "0";
        open_ = nullptr;
    }

    void use_material() {
        material_ = lines_.rest();
        open_ = nullptr;
    }

    void object() {
        object_ = lines_.rest();
        open_ = nullptr;
    }

    Counts counts() const { return {lists_.positions.size(), lists_.uvs.size(), lists_.normals.size()}; }

    /// `number`: from 0 on; `so_far`: where it stands; `last`: nothing comes later.
    void face(std::size_t number, const Counts& so_far, bool last) {
        const auto words = lines_.left();
        corners_.clear();
        CornerReader reader(so_far, counts(), last, lines_, report_);
        for (auto word = lines_.word(); !word.empty() && word.front() != '#'; word = lines_.word()) {
            const auto read = reader.read(word);
            if (reader.names_later())
                return waiting_.push_back(
                    {number, std::string(words), lines_.where(), object_, material_, smooth_, so_far});
            if (!read) return;
            corners_.push_back(*read);
        }
        if (corners_.size() < 3)
            return report_.warn(lines_.where(), "faces of fewer than three corners have no surface and are left out");
        Open& open = this->open();
        if (open.subdivided) return cages_.add({corners_, number, object_, material_, lines_.where()}, report_);
        auto& mesh = open.part.mesh;
        vertices_.clear();
        for (const Corner& corner : corners_) vertices_.push_back(vertex_of(open, corner));
        triangulate(mesh.positions, vertices_, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            mesh.triangles.push_back({a, b, c});
        });
    }

    /// Once all vertices are there.
    void finish_waiting() {
        for (auto& face : std::exchange(waiting_, {})) {
            if (report_.full()) return;
            lines_.begin(face.words, face.where.line);
            object_ = std::move(face.object), material_ = std::move(face.material), smooth_ = face.smooth;
            open_ = nullptr;
            this->face(face.number, face.counts, true);
        }
    }

    Open& open() {
        if (open_) return *open_;
        const auto key = cut_ == Cut::nowhere ? Key() : Key(object_, material_, smooth_);
        const auto [entry, fresh] = index_.try_emplace(key, parts_.size());
        if (fresh)
            parts_.push_back({{{}, std::get<1>(key), smooth_, lines_.where(), std::get<0>(key)},
                              {},
                              false,
                              false,
                              cages_.levels(std::get<0>(key)) > 0});
        return *(open_ = &parts_[entry->second]);
    }

    std::uint32_t vertex_of(Open& open, const Corner& corner) {
        Mesh& mesh = open.part.mesh;
        const auto [entry, fresh] = open.vertices.try_emplace(corner, std::uint32_t(mesh.positions.size()));
        if (!fresh) return entry->second;
        mesh.positions.push_back(lists_.positions[corner.position]);
        mesh.uvs.push_back(corner.uv == none ? Vec2{} : lists_.uvs[corner.uv]);
        mesh.normals.push_back(corner.normal == none ? Vec3{} : lists_.normals[corner.normal]);
        if (corner.position < lists_.colours.size()) mesh.colours.push_back(lists_.colours[corner.position]);
        open.uvs = open.uvs || corner.uv != none;
        open.normals = open.normals || corner.normal != none;
        return entry->second;
    }

    Part finished(Open open) {
        Mesh& mesh = open.part.mesh;
        if (!open.uvs) mesh.uvs = {};
        if (!open.normals) mesh.normals = {};
        if (mesh.colours.size() != mesh.positions.size()) mesh.colours = {};
        return std::move(open.part);
    }

    Lines lines_;
    Cut cut_;
    Report& report_;
    Mesh lists_;  // of the file, which its faces name
    std::vector<Library> libraries_;
    std::string object_, material_;
    bool smooth_ = false;
    std::vector<Open> parts_;
    std::map<Key, std::size_t> index_;
    Open* open_ = nullptr;  // one of parts_; null: to be looked up
    Cages cages_;
    std::size_t faces_ = 0;
    std::vector<Corner> corners_;          // of one face
    std::vector<std::uint32_t> vertices_;  // these in its mesh
    std::vector<Waiting> waiting_;
};

}  // namespace

Model read_model(std::span<const std::byte> bytes, const std::string& file, Cut cut, Report& report,
                 const std::vector<Subdivision>& subdivided) {
    return ModelReader(bytes, file, cut, report, subdivided).read();
}

}  // namespace lightnet::obj
