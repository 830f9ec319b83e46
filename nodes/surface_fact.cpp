// Facts about what the eye sees, for compositing.
#include <string>
#include <utility>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/film/picture.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/screen_motion.hpp"

namespace lightnet {
namespace {

/// Where the eye is and how it looks, in world space.
struct Eye {
    explicit Eye(const CameraData& camera)
        : position(transform_point(camera.to_world, {0, 0, 0})),
          right(normalize(transform_direction(camera.to_world, {1, 0, 0}))),
          up(normalize(transform_direction(camera.to_world, {0, 1, 0}))),
          ahead(normalize(transform_direction(camera.to_world, {0, 0, 1}))) {}
    Vec3 position, right, up, ahead;
};

Rgb grey(float value) { return {value, value, value}; }
Rgb of_vector(Vec3 v) { return {v.x, v.y, v.z}; }

/// Answers with one fact about each surface point that it is asked about, in scene units where it is a length.
class SurfaceFact final : public LightOp {
public:
    explicit SurfaceFact(const NodeContext& here)
        : scene_(here.scene()),
          eye_(here.scene().seen_from()),
          motion_(here.scene()),
          key_(here.key()),
          fact_(fact_called(here.text("of"))) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        for (std::size_t i = 0; i < questions.size(); ++i)
            answers[i] = (this->*fact_)(scene_.surface(questions[i]), questions[i]);
    }

    // As compositing programs expect them.
    static std::string letters(const Node& node) {
        const auto& of = std::get<std::string>(node.params.at("of").data);
        if (of == "depth" || of == "distance") return letters_of_depths;
        if (of == "position" || of == "normal" || of == "camera_normal") return letters_of_vectors;
        if (of == "motion") return letters_of_motion;
        return of == "uv" ? letters_of_uv : usual_letters;
    }

    static std::vector<std::string> names() {
        std::vector<std::string> names;
        for (const auto& [name, fact] : facts) names.emplace_back(name);
        return names;
    }

private:
    using Fact = Rgb (SurfaceFact::*)(const SurfacePoint&, const Query&) const;

    Rgb coverage(const SurfacePoint&, const Query&) const { return grey(1); }
    Rgb depth(const SurfacePoint& point, const Query&) const {
        return grey(dot(point.position - eye_.position, eye_.ahead));
    }
    Rgb distance(const SurfacePoint& point, const Query&) const { return grey(length(point.position - eye_.position)); }
    Rgb position(const SurfacePoint& point, const Query&) const { return of_vector(point.position); }
    Rgb normal(const SurfacePoint& point, const Query& question) const {
        const Vec3 normal = point.shading.z;
        return of_vector(dot(point.normal, question.outgoing) < 0 ? -normal : normal);
    }
    Rgb camera_normal(const SurfacePoint& point, const Query& question) const {
        const Rgb world = normal(point, question);
        const Vec3 n{world.r, world.g, world.b};
        return {dot(n, eye_.right), dot(n, eye_.up), -dot(n, eye_.ahead)};
    }
    Rgb uv(const SurfacePoint& point, const Query& question) const {
        if (question.is_in_space()) return {};
        const Vec2 at = scene_.texture_coordinates(point);
        return {at.x, at.y, 0};
    }
    Rgb motion(const SurfacePoint&, const Query& question) const {
        const Vec2 pixels = motion_.of(question);
        return {pixels.x, pixels.y, 0};
    }
    // The mean of many samples' weights is the albedo for light that leaves towards the eye.
    Rgb albedo(const SurfacePoint& point, const Query& question) const {
        Samples samples(child(question.stream, key_), question.sample);
        const float choice = samples.next();
        const auto sample = scene_.bsdf(point).sample(question.outgoing, choice, samples.next_2d(), lobe::all);
        return sample ? sample->weight : Rgb{};
    }

    static const std::vector<std::pair<const char*, Fact>> facts;

    static Fact fact_called(const std::string& name) {
        for (const auto& [known, fact] : facts)
            if (known == name) return fact;
        return &SurfaceFact::coverage;  // the schema knows these names and no others
    }

    const Scene& scene_;
    Eye eye_;
    ScreenMotion motion_;
    Key key_;
    Fact fact_;
};

const std::vector<std::pair<const char*, SurfaceFact::Fact>> SurfaceFact::facts{
    {"coverage", &SurfaceFact::coverage},
    {"depth", &SurfaceFact::depth},
    {"distance", &SurfaceFact::distance},
    {"position", &SurfaceFact::position},
    {"normal", &SurfaceFact::normal},
    {"camera_normal", &SurfaceFact::camera_normal},
    {"uv", &SurfaceFact::uv},
    {"motion", &SurfaceFact::motion},
    {"albedo", &SurfaceFact::albedo}};

// Motion is asked of all that moves until the next frame.
SceneParts read_by_fact(const Node& node) {
    const auto of = node.params.find("of");
    const bool motion = of == node.params.end() || std::get<std::string>(of->second.data) == "motion";
    return motion ? whole_scene : scene_of_light | ScenePart::camera | ScenePart::film;
}

}  // namespace

Kind surface_fact_kind() {
    return {
        .name = "SurfaceFact",
        .help = "an AOV, no light: one fact about the first surface that the eye meets, mirrors and glass included",
        .params =
            {{.name = "of",
              .type = ParamType::text,
              .help =
                  "coverage: 1; depth: along the camera's axis; distance: from the eye; position and normal: in "
                  "the world; camera_normal: x right, y up, z to the eye; uv: of the texture; motion: pixels to the "
                  "right and upwards until the next frame; albedo: of all lobes, towards the eye",
              .choices = SurfaceFact::names()}},
        .light = {.facts = true, .letters = SurfaceFact::letters, .paths = always({})},
        .reads = read_by_fact,
        .make_light = [](const NodeContext& here) { return std::make_unique<SurfaceFact>(here); },
    };
}

}  // namespace lightnet
