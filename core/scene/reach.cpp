#include "core/scene/reach.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "core/scene/camera/camera.hpp"
#include "core/scene/surfaces/placement.hpp"

namespace lightnet {
namespace {

std::string too_far(const char* what) {
    return fmt::format("{} lies beyond {:g}, where no ray can be traced", what, farthest);
}

// Can Embree meet triangles of that size with rays that begin as far away? It works with the product of three
// distances in single precision, and where that is no number finds nothing.
bool is_meetable(double size, double reach) { return size * size * reach <= 8e36; }

// Where a question for a place finds one: of the first shape, as instances are too many to have lines.
SourceLine place_of(const SceneData& scene, const Object& object, const std::string& file) {
    return object.shapes.empty() ? SourceLine{file, 0} : scene.shapes[object.shapes.front()].where;
}

double row_sum(const Matrix& m, std::size_t i, double reach) {
    double sum = std::fabs(m.m[i][3]);
    for (std::size_t j = 0; j < 3; ++j) sum += std::fabs(m.m[i][j]) * reach;
    return sum;
}

double largest_row(const Matrix& m, double reach) {
    double most = 0;
    for (std::size_t i = 0; i < 3; ++i) most = std::max(most, row_sum(m, i, reach));
    return most;
}

// Shapes and objects by their extents; what is found wrong goes to `problems`.
class Reach {
public:
    Reach(const SceneData& scene, const std::string& file, std::vector<Problem>& problems)
        : scene_(scene), file_(file), problems_(problems), of_shape_(scene.shapes.size()) {}

    void check() {
        std::vector<bool> placed(scene_.shapes.size());
        for (const auto& object : scene_.objects)
            for (const auto shape : object.shapes)
                if (shape < placed.size()) placed[shape] = true;
        for (std::size_t s = 0; s < scene_.shapes.size(); ++s) {
            look_at(s);
            if (!placed[s]) most_ = std::max(most_, double{of_shape_[s]});
        }
        if (scene_.camera_given) most_ = std::max(most_, largest_row(scene_.camera.to_world, 0));
        if (!problems_.empty()) return;
        for (const auto& instance : scene_.instances) grow(instance);
        for (std::size_t s = 0; s < scene_.shapes.size(); ++s)
            if (!placed[s] && problems_.size() < most_problems) check_size(scene_.shapes[s], of_shape_[s], most_);
        for (const auto& instance : scene_.instances)
            if (problems_.empty()) look_into(instance);
    }

private:
    void look_at(std::size_t s) {
        const Shape& shape = scene_.shapes[s];
        std::visit([&](const auto& geometry) { look_at(s, shape, geometry); }, shape.geometry);
    }
    template <IsShape S>
    void look_at(std::size_t s, const Shape& shape, const S& geometry) {
        of_shape_[s] = geometry.extent();
        if (!in_reach(of_shape_[s]) && problems_.size() < most_problems)
            problems_.push_back({shape.where, too_far(S::part)});
    }
    static float largest_piece(const Shape& shape) {
        return std::visit([](const auto& geometry) { return geometry.largest_piece(); }, shape.geometry);
    }
    // `extent`: of the shape, which is cheaper to know than its size and nearly always small enough.
    void check_size(const Shape& shape, double extent, double reach) {
        if (is_meetable(2 * extent, reach) || is_meetable(largest_piece(shape), reach)) return;
        problems_.push_back({shape.where, fmt::format("its triangles are so large that no ray from {:.0e} units away, "
                                                      "where the scene ends, can meet them: scale the scene down",
                                                      reach)});
    }
    double extent_of_object(const Object& object) const {
        double most = 0;
        for (const auto shape : object.shapes)
            if (shape < of_shape_.size()) most = std::max(most, double{of_shape_[shape]});
        return most;
    }
    void grow(const Instance& instance) {
        if (instance.object >= scene_.objects.size()) return;
        const Object& object = scene_.objects[instance.object];
        const double reach = largest_row(instance.to_world, extent_of_object(object));
        most_ = std::max(most_, reach);
        if (!(reach <= double{farthest}) && problems_.empty())
            problems_.push_back({place_of(scene_, object, file_), too_far("an instance of this object")});
    }
    // A ray that is taken into a tiny object gets long.
    void look_into(const Instance& instance) {
        if (instance.object >= scene_.objects.size()) return;
        const auto where = [&] { return place_of(scene_, scene_.objects[instance.object], file_); };
        if (const std::string fault = Placement::fault(instance.to_world); !fault.empty())
            return problems_.push_back({where(), fault});
        const double reach = Placement(instance.to_world).farthest_inside(most_);
        if (reach > 1e17)
            return problems_.push_back(
                {where(), "an instance makes this object so small that no ray of the scene can be traced in it"});
        for (const auto shape : scene_.objects[instance.object].shapes)
            if (shape < of_shape_.size() && problems_.empty())
                check_size(scene_.shapes[shape], of_shape_[shape], reach);
    }

    static constexpr std::size_t most_problems = 100;
    const SceneData& scene_;
    const std::string& file_;
    std::vector<Problem>& problems_;
    std::vector<float> of_shape_;
    double most_ = 0;  // of all coordinates in the world
};

}  // namespace

bool in_reach(const BareLight& light) {
    return std::visit(
        []<IsLight L>(const L& one) {
            if constexpr (IsNear<L>) return in_reach(one.position);
            return true;
        },
        light);
}

std::string camera_fault(const CameraData& data, const FilmData& film) {
    const Camera camera(data, film.width, film.height);
    const float width = float(film.width), height = float(film.height);
    const auto traceable = [](const Ray& ray) {
        return finite(ray.direction) && ray.direction != Vec3{} && length(ray.direction) < 2;
    };
    bool near = true, sound = true;
    for (const float x : {0.0f, width / 2, width})
        for (const float y : {0.0f, height / 2, height})
            for (const Vec2 lens : {Vec2{0.5f, 0.5f}, Vec2{0, 0.5f}, Vec2{0.5f, 0.999f}}) {
                const Ray ray = data.lens_radius > 0 ? camera.ray(x, y, lens) : camera.ray(x, y);
                near &= in_reach(ray.origin);
                sound &= traceable(ray);
            }
    if (!near) return too_far("the camera");
    if (!sound) return "the camera's rays have no direction: its angle of view, its screen or its transform is extreme";
    return "";
}

std::vector<Problem> out_of_reach(const SceneData& scene, const std::string& file) {
    std::vector<Problem> problems;
    const auto look_at = [&](const CameraData& camera, const FilmData& film) {
        const auto fault = camera_fault(camera, film);
        const Problem problem{camera.where.file.empty() ? SourceLine{file, 0} : camera.where, fault};
        if (!fault.empty() && std::find(problems.begin(), problems.end(), problem) == problems.end())
            problems.push_back(problem);
    };
    if (scene.camera_given) look_at(scene.camera, scene.film);
    for (const auto& each : scene.cameras) look_at(each.camera, each.film);
    Reach(scene, file, problems).check();
    return problems;
}

}  // namespace lightnet
