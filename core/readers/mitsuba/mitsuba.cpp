#include "core/readers/mitsuba/mitsuba.hpp"

#include <fmt/format.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/readers/common/clipping.hpp"
#include "core/readers/common/moment.hpp"
#include "core/readers/mitsuba/emitters.hpp"
#include "core/readers/mitsuba/sensors.hpp"
#include "core/readers/mitsuba/shapes.hpp"

namespace lightnet::mitsuba {
namespace {

/// Goes through the scene's own elements; what is only referred to is made when it is asked for.
class Builder {
public:
    explicit Builder(const Context& context)
        : context_(context),
          textures_(context),
          bsdfs_(textures_),
          media_(context),
          shapes_(bsdfs_, textures_, media_) {}

    void add(const Node& node) {
        static const std::set<std::string, std::less<>> silent{"integrator", "sampler", "film", "rfilter",
                                                               "bsdf",       "texture", "mode", "phase"};
        if (node.tag == "integrator") name_hidden(node);
        if (node.tag == "shape") return shapes_.add(node);
        if (node.tag == "emitter") return add_emitter(node, textures_);
        if (node.tag == "sensor") return sensor(node);
        if (node.tag == "ref") return referred(node);
        static const std::set<std::string, std::less<>> parts{"medium", "spectrum", "volume", "rgb"};
        if (silent.contains(node.tag) || node.name == "scene_scale") return;
        if (parts.contains(node.tag) && context_.document.lent.contains(node.id)) return;  // said where it is lent to
        if (node.tag == "medium")
            context_.warn(node, "<medium> fills nothing: no shape names it");
        else
            unknown(node);
    }

    /// Once all shapes are there.
    void finish() {
        SceneData& scene = context_.assets.scene();
        for (std::size_t i = 0; i < depths_.size(); ++i)
            clip(scene.cameras[i].camera, depths_[i].nearest, depths_[i].farthest, scene);
        if (depths_.empty()) return;
        scene.camera.nearest = scene.cameras[0].camera.nearest;
        scene.camera.farthest = scene.cameras[0].camera.farthest;
    }

    /// What is wrong with a scene that has no shapes.
    std::string why_empty() const {
        if (first_unknown_.empty()) return "there are no shapes";
        return fmt::format(
            "there are no shapes, and <{}> is none of Mitsuba's elements (other formats in XML, such as "
            "Embree's, aren't read)",
            first_unknown_.substr(0, 32));
    }

private:
    void sensor(const Node& node) {
        SceneData& scene = context_.assets.scene();
        const CameraData camera = scene.camera;
        const FilmData film = scene.film;
        const auto shutter = scene.shutter;
        depths_.push_back(set_sensor(node, context_));
        for (const auto& child : node.children)
            if (child->tag == "medium" || child->tag == "ref")
                if (const Node* target = context_.resolved(*child); target && target->tag == "medium")
                    scene.around = media_.made(*target);
        scene.cameras.push_back({node.id, scene.camera, scene.film});
        if (scene.cameras.size() > 1) scene.camera = camera, scene.film = film, scene.shutter = shutter;
    }

    void referred(const Node& node) {
        const Node* target = context_.resolved(node);
        if (target && target->tag != "ref" && target->tag != "shape") add(*target);
    }

    /// Integrators may be inside of others.
    void name_hidden(const Node& integrator) {
        for (const auto& child : integrator.children)
            if (child->tag == "integrator")
                name_hidden(*child);
            else if (child->name == "hide_emitters" && child->attribute("value") == "true")
                context_.warn(*child, "'hide_emitters' is left out: the camera sees lamps and what is around");
    }

    void unknown(const Node& node) {
        if (first_unknown_.empty()) first_unknown_ = node.tag;
        context_.warn(node, fmt::format("unknown element <{}> is left out: the picture shows nothing of it", node.tag));
    }

    const Context& context_;
    Textures textures_;
    Bsdfs bsdfs_;
    Media media_;
    Shapes shapes_;
    std::vector<SensorDepth> depths_;  // by camera
    std::string first_unknown_;
};

SceneData read(Files& files, const std::string& path, const SceneConstants& given) {
    SceneConstants constants = given;
    const auto seconds = take_moment(constants, path, "Mitsuba's animations have");
    return read_by_assets(files, path, [&](Assets& assets) {
        Report& report = assets.report();
        SceneData& scene = assets.scene();
        const auto document = read_document(assets, path, constants);
        report.check();
        const Context context{assets, *document, seconds};
        Builder builder(context);
        for (const auto& node : document->scene.children)
            if (!report.full()) builder.add(*node);
        if (report.good()) builder.finish();
        // a sky may be all there is to see
        if (scene.shapes.empty() && report.good() && (scene.environments.empty() || !scene.camera_given))
            report.error({path, 0}, builder.why_empty());
    });
}

}  // namespace

SceneFormat format() {
    return {.endings = {".xml"}, .maker = "Mitsuba", .has_variables = true, .moves = true, .read = read};
}

}  // namespace lightnet::mitsuba
