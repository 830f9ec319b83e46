#include "core/readers/obj/cages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "core/base/suggestion.hpp"
#include "core/scene/data/lamp_names.hpp"

namespace lightnet::obj {
namespace {

constexpr int usual_levels = 3;

/// Places in a file's lists, as places in those of one cage.
class Renumbered {
public:
    std::uint32_t operator[](std::uint32_t place) {
        const auto [at, fresh] = of_.try_emplace(place, std::uint32_t(places_.size()));
        if (fresh) places_.push_back(place);
        return at->second;
    }
    const std::vector<std::uint32_t>& places() const { return places_; }
    const std::map<std::uint32_t, std::uint32_t>& all() const { return of_; }

private:
    std::map<std::uint32_t, std::uint32_t> of_;
    std::vector<std::uint32_t> places_;
};

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
    return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
}

std::vector<std::uint64_t> edges_of(const Cage& cage) {
    std::vector<std::uint64_t> edges;
    std::size_t first = 0;
    for (const std::uint32_t size : cage.sizes) {
        for (std::uint32_t i = 0; i < size; ++i)
            edges.push_back(edge_key(cage.corners[first + i], cage.corners[first + (i + 1) % size]));
        first += size;
    }
    std::ranges::sort(edges);
    return edges;
}

/// The triangles of each part, `part_of` telling of each face of the cage to which it belongs.
void cut(Subdivided&& whole, const std::vector<std::uint32_t>& part_of, std::vector<Part>& parts) {
    if (parts.size() == 1) {
        parts.front().mesh = std::move(whole.mesh);
        return;
    }
    const Mesh& all = whole.mesh;
    std::vector<Renumbered> vertices(parts.size());
    for (std::size_t i = 0; i < all.triangles.size(); ++i) {
        const auto part = part_of[whole.face_of[i]];
        const auto& [a, b, c] = all.triangles[i];
        auto& number = vertices[part];
        const auto first = number[a], second = number[b], third = number[c];
        parts[part].mesh.triangles.push_back({first, second, third});
    }
    for (std::size_t part = 0; part < parts.size(); ++part)
        for (const auto vertex : vertices[part].places()) {
            Mesh& mesh = parts[part].mesh;
            mesh.positions.push_back(all.positions[vertex]);
            mesh.normals.push_back(all.normals[vertex]);
            if (!all.uvs.empty()) mesh.uvs.push_back(all.uvs[vertex]);
            if (!all.colours.empty()) mesh.colours.push_back(all.colours[vertex]);
        }
}

std::optional<std::size_t> whole_number(std::string_view digits) {
    std::size_t value = 0;
    const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (problem != std::errc{} || end != digits.data() + digits.size() || value >= Corner::none) return std::nullopt;
    return value;
}

}  // namespace

Cages::Cages(const std::vector<Subdivision>& wanted, bool tagged) : wanted_(wanted), tagged_(tagged) {}

int Cages::levels(const std::string& object) {
    seen_.insert(object);
    const Subdivision* found = nullptr;
    for (const Subdivision& wish : wanted_)
        if (wish.object == "*" || goes_by(object, wish.object)) {
            named_.insert(wish.object);
            if (!found || wish.object == object) found = &wish;
        }
    return found ? found->levels : tagged_ ? usual_levels : 0;
}

void Cages::add(const CageFace& face, Report& report) {
    const auto same = [](const Corner& a, const Corner& b) { return a.position == b.position; };
    for (std::size_t i = 0; i < face.corners.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (same(face.corners[i], face.corners[j]))
                return report.warn(face.where, "faces that name a vertex twice are left out of what is subdivided");
    Object& object = objects_[face.object];
    object.levels = levels(face.object);
    const auto part = std::ranges::find(object.parts, face.material, &Part::material);
    object.part_of.push_back(std::uint32_t(part - object.parts.begin()));
    if (part == object.parts.end()) object.parts.push_back({{}, face.material, false, face.where, face.object});
    object.sizes.push_back(std::uint32_t(face.corners.size()));
    object.numbers.push_back(face.number);
    object.corners.insert(object.corners.end(), face.corners.begin(), face.corners.end());
}

bool Cages::numbers_of(Lines& lines, std::vector<std::size_t>& whole, std::vector<float>& sharp, Report& report) const {
    const auto counts = lines.word();
    const auto first = counts.find('/'), second = counts.find('/', first + 1);
    if (first == counts.npos || second == counts.npos) return false;
    const auto wholes = whole_number(counts.substr(0, first)),
               sharps = whole_number(counts.substr(first + 1, second - first - 1));
    for (std::size_t i = 0; wholes && i < *wholes; ++i) {
        const auto number = whole_number(lines.word());
        if (!number) return false;
        whole.push_back(*number);
    }
    for (std::size_t i = 0; sharps && i < *sharps; ++i) {
        const auto number = lines.number(report);
        if (!number) return false;
        sharp.push_back(std::max(*number, 0.0f));
    }
    return wholes && sharps;
}

void Cages::tag(Lines& lines, Report& report) {
    const std::string name(lines.word());
    const auto leave_out = [&] {
        report.warn(lines.where(), fmt::format("tag '{}' is left out: the surface shows nothing of it", name));
    };
    if (std::ranges::find(known_tags, name) == known_tags.end()) return leave_out();
    std::vector<std::size_t> whole;
    std::vector<float> sharp;
    if (!numbers_of(lines, whole, sharp, report))
        return report.error(lines.where(), fmt::format("tag '{}' needs as many numbers as it says", name));
    const auto sharpness = [&](std::size_t i) { return sharp.empty() ? 0 : sharp.size() == 1 ? sharp[0] : sharp[i]; };
    const bool enough = sharp.size() == 1 || sharp.size() >= whole.size();
    if (name == "crease" && whole.size() % 2 == 0 && (enough || 2 * sharp.size() == whole.size()))
        for (std::size_t i = 0; i < whole.size(); i += 2)
            creases_.push_back({whole[i], whole[i + 1], sharpness(enough ? i : i / 2), lines.where()});
    else if (name == "corner" && enough)
        for (std::size_t i = 0; i < whole.size(); ++i) tips_.push_back({whole[i], sharpness(i)});
    else if (name == "hole")
        holes_.insert(whole.begin(), whole.end());
    else if (name == "interpolateboundary" && whole.size() == 1 && whole[0] < 3)
        rules_.borders = Cage::Borders(whole[0]);
    else if (name == "facevaryinginterpolateboundary" && whole.size() == 1 && whole[0] < 6)
        rules_.straight_uvs = int(whole[0]);
    else if (name == "creasemethod")
        rules_.chaikin = lines.word() == "chaikin";
    else
        leave_out();
}

void Cages::add_creases(const std::map<std::uint32_t, std::uint32_t>& vertices, Cage& cage) {
    if (creases_.empty()) return;
    const auto edges = edges_of(cage);
    for (std::size_t i = 0; i < creases_.size(); ++i) {
        const auto a = vertices.find(std::uint32_t(creases_[i].a)), b = vertices.find(std::uint32_t(creases_[i].b));
        if (a == vertices.end() || b == vertices.end()) continue;
        if (!std::ranges::binary_search(edges, edge_key(a->second, b->second))) continue;
        found_[i] = true;
        cage.creases.push_back({a->second, b->second, creases_[i].sharpness});
    }
}

Cage Cages::cage_of(const Object& object, const Mesh& lists) {
    Cage cage = rules_;
    Renumbered vertices, uvs;
    cage.sizes = object.sizes;
    const bool laid = std::ranges::any_of(object.corners, [](const Corner& c) { return c.uv != Corner::none; });
    for (const Corner& corner : object.corners) {
        cage.corners.push_back(vertices[corner.position]);
        if (laid) cage.uv_corners.push_back(uvs[corner.uv]);
    }
    const auto& places = vertices.places();
    const bool painted = std::ranges::all_of(places, [&](auto place) { return place < lists.colours.size(); });
    for (const auto place : places) {
        cage.positions.push_back(lists.positions[place]);
        if (painted) cage.colours.push_back(lists.colours[place]);
    }
    for (const auto place : uvs.places()) cage.uvs.push_back(place == Corner::none ? Vec2{} : lists.uvs[place]);
    add_creases(vertices.all(), cage);
    for (const Tip& tip : tips_)
        if (const auto found = vertices.all().find(std::uint32_t(tip.vertex)); found != vertices.all().end())
            cage.tips.push_back({found->second, tip.sharpness});
    for (std::size_t face = 0; face < object.numbers.size(); ++face)
        if (holes_.contains(object.numbers[face])) cage.holes.push_back(std::uint32_t(face));
    return cage;
}

std::vector<Part> Cages::finish(const Mesh& lists, const std::string& file, Report& report) {
    std::vector<Part> parts;
    found_.assign(creases_.size(), false);
    for (auto& [name, object] : objects_) try {
            cut(subdivided(cage_of(object, lists), object.levels), object.part_of, object.parts);
            for (Part& part : object.parts)
                if (!part.mesh.triangles.empty()) parts.push_back(std::move(part));
        } catch (const Error& error) {
            report.error(object.parts.front().where, fmt::format("'{}' can't be subdivided: {}", name, error.what()));
        }
    for (std::size_t i = 0; i < creases_.size(); ++i)
        if (!found_[i]) report.warn(creases_[i].where, "creases name edges that no face has, and are left out");
    for (const Subdivision& wish : wanted_)
        if (!named_.contains(wish.object))
            report.error({file, 0}, fmt::format("'subdivision': no object is called '{}'{}", wish.object,
                                                did_you_mean(wish.object, {seen_.begin(), seen_.end()})));
    return parts;
}

}  // namespace lightnet::obj
