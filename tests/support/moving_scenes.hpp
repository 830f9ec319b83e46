// Small scenes in each of which something else moves, in files as users have them.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "core/readers/read_scene.hpp"
#include "tests/support/gltf_text.hpp"
#include "tests/support/memory_files.hpp"

namespace lightnet::test {

/// A file that moves from 0 to 1 s.
struct MovingScene {
    std::string name, path;
    std::string text;

    /// All stands as at that time.
    SceneData at(double seconds) const { return read({{std::string(time_constant), fmt::format("{}", seconds)}}); }
    /// The shutter is open for all of the second.
    SceneData blurred() const {
        return read({{std::string(time_constant), "0"}, {std::string(shutter_constant), "0 1"}});
    }

private:
    SceneData read(const SceneConstants& constants) const {
        MemoryFiles files{{path, text}};
        return read_scene(files, path, constants);
    }
};

inline std::ostream& operator<<(std::ostream& out, const MovingScene& scene) { return out << scene.name; }

/// Mitsuba's sensor, between two keys.
inline MovingScene panning_camera() {
    return {"CameraPan", "pan.xml", R"(<scene version="3.0.0">
      <sensor type="perspective"><float name="fov" value="50"/><animation name="to_world">
        <transform time="0"><lookat origin="-0.6,1,4" target="-1.2,0.6,0" up="0,1,0"/></transform>
        <transform time="1"><lookat origin="0.6,1.3,4" target="1.2,0.4,0" up="0,1,0"/></transform></animation></sensor>
      <emitter type="constant"><rgb name="radiance" value="0.4,0.5,0.6"/></emitter>
      <bsdf type="diffuse" id="matte"><rgb name="reflectance" value="0.7,0.3,0.2"/></bsdf>
      <bsdf type="diffuse" id="grey"><rgb name="reflectance" value="0.5,0.5,0.5"/></bsdf>
      <shape type="rectangle"><transform name="to_world"><scale value="9"/><rotate x="1" angle="-90"/></transform>
        <ref id="grey"/></shape>
      <shape type="sphere"><point name="center" x="-0.9" y="0.6" z="0"/><float name="radius" value="0.6"/>
        <ref id="matte"/></shape>
      <shape type="cube"><transform name="to_world"><scale value="0.4"/><rotate y="1" angle="30"/>
        <translate x="0.9" y="0.4" z="0.3"/></transform><ref id="matte"/></shape>
      <shape type="sphere"><point name="center" x="0.2" y="2" z="-0.5"/><float name="radius" value="0.5"/>
        <emitter type="area"><rgb name="radiance" value="2.5,2.2,2"/></emitter></shape></scene>)"};
}

/// What all scenes in glTF have: a floor, a camera and a lamp; nodes from 0 on are the caller's, meshes too.
struct GltfStage {
    GltfText text;

    std::string numbers(const std::vector<float>& of, const std::string& type = "VEC3") {
        return std::to_string(text.vectors(type, of));
    }
    /// A file of these nodes and meshes, which are lists without brackets; `more` ends in a comma.
    std::string file(const std::string& nodes, std::size_t count, const std::string& meshes, std::size_t mesh_count,
                     const std::string& more) {
        const std::string floor = numbers({-9, 0, -9, 9, 0, -9, -9, 0, 9, 9, 0, 9});
        const std::string order = std::to_string(text.accessor<std::uint16_t>("SCALAR", 5123, {0, 2, 1, 1, 2, 3}, 6));
        std::string list;
        for (std::size_t i = 0; i < count + 3; ++i) list += (i ? "," : "") + std::to_string(i);
        return text.file(
            R"("scene":0,"scenes":[{"nodes":[)" + roots_.value_or(list) + R"(]}],"nodes":[)" + nodes +
            fmt::format(R"(,{{"mesh":{}}},{{"camera":0,"translation":[0,1,4]}},)"
                        R"({{"translation":[1.5,3,2],"extensions":{{"KHR_lights_punctual":{{"light":0}}}}}}],)",
                        mesh_count) +
            R"("meshes":[)" + meshes + R"(,{"primitives":[{"material":1,"attributes":{"POSITION":)" + floor +
            R"(},"indices":)" + order + R"(}]}],)" + more +
            R"("materials":[{"doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[0.7,0.3,0.2,1],
            "metallicFactor":0,"roughnessFactor":1}},{"doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":
            [0.5,0.5,0.5,1],"metallicFactor":0,"roughnessFactor":1}}],"extensionsUsed":["KHR_lights_punctual"],
            "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":12}]}},
            "cameras":[{"type":"perspective","perspective":{"yfov":0.8,"znear":0.1}}],)");
    }
    void roots(const std::string& list) { roots_ = list; }

private:
    std::optional<std::string> roots_;
};

/// One sampler after the other, all LINEAR unless they say so.
inline std::string animation(const std::string& samplers, const std::string& channels) {
    return R"("animations":[{"name":"go","samplers":[)" + samplers + R"(],"channels":[)" + channels + "]}],";
}

/// Five spokes that turn by 200 degrees, in two steps.
inline MovingScene spinning_wheel() {
    GltfStage stage;
    std::vector<float> corners;
    for (int spoke = 0; spoke < 5; ++spoke) {
        const float angle = float(spoke) * 0.4f * std::numbers::pi_v<float>, c = std::cos(angle), s = std::sin(angle);
        corners.insert(corners.end(), {-0.15f * s, 0.15f * c, 0, 0.15f * s, -0.15f * c, 0, 0.9f * c, 0.9f * s,
                                       spoke % 2 ? 0.2f : 0.f});
    }
    const std::string mesh = stage.numbers(corners), times = stage.numbers({0, 0.5f, 1}, "SCALAR");
    const auto turned = [](double degrees) { return float(degrees * std::numbers::pi / 360); };
    const std::string turns = stage.numbers({0, 0, 0, 1, 0, 0, std::sin(turned(120)), std::cos(turned(120)), 0, 0,
                                             std::sin(turned(200)), std::cos(turned(200))},
                                            "VEC4");
    return {"SpinningWheel", "wheel.glb",
            stage.file(R"({"mesh":0,"translation":[0,1,0.3]})", 1,
                       R"({"primitives":[{"material":0,"attributes":{"POSITION":)" + mesh + "}}]}", 1,
                       animation(R"({"input":)" + times + R"(,"output":)" + turns + "}",
                                 R"({"sampler":0,"target":{"node":0,"path":"rotation"}})"))};
}

/// A strip that hangs on two joints: its root goes sideways, and its upper half bends.
inline MovingScene skinned_figure() {
    GltfStage stage;
    std::vector<float> corners, weights;
    std::vector<std::uint8_t> joints;
    std::vector<std::uint16_t> order;
    for (std::uint16_t rung = 0; rung <= 6; ++rung) {
        const float height = float(rung) * 0.3f, above = std::clamp((height - 0.6f) / 0.6f, 0.f, 1.f);
        for (const float x : {-0.25f, 0.25f}) {
            corners.insert(corners.end(), {x, height, 0});
            joints.insert(joints.end(), {0, 1, 0, 0});
            weights.insert(weights.end(), {1 - above, above, 0, 0});
        }
        const auto a = std::uint16_t(2 * rung);
        if (rung < 6)
            for (const int corner : {0, 1, 2, 2, 1, 3}) order.push_back(std::uint16_t(a + corner));
    }
    const std::string mesh = R"({"primitives":[{"material":0,"attributes":{"POSITION":)" + stage.numbers(corners) +
                             R"(,"JOINTS_0":)" +
                             std::to_string(stage.text.accessor("VEC4", 5121, joints, joints.size() / 4)) +
                             R"(,"WEIGHTS_0":)" + stage.numbers(weights, "VEC4") + R"(},"indices":)" +
                             std::to_string(stage.text.accessor("SCALAR", 5123, order, order.size())) + "}]}";
    const std::string unbind = stage.numbers(
        {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -0.9f, 0, 1}, "MAT4");
    const std::string times = stage.numbers({0, 1}, "SCALAR"), moves = stage.numbers({-0.5f, 0, 0, 0.3f, 0, 0});
    const std::string turns = stage.numbers({0, 0, 0.3f, std::sqrt(0.91f), 0, 0, -0.6f, 0.8f}, "VEC4");
    stage.roots("0,1,3,4,5");
    return {"SkinnedFigure", "figure.glb",
            stage.file(R"({"mesh":0,"skin":0,"translation":[9,9,9]},{"children":[2]},{"translation":[0,0.9,0]})", 3,
                       mesh, 1,
                       R"("skins":[{"joints":[1,2],"inverseBindMatrices":)" + unbind + "}]," +
                           animation(R"({"input":)" + times + R"(,"output":)" + moves + R"(},{"input":)" + times +
                                         R"(,"output":)" + turns + "}",
                                     R"({"sampler":0,"target":{"node":1,"path":"translation"}},
                                        {"sampler":1,"target":{"node":2,"path":"rotation"}})"))};
}

/// A sheet that waves by two morph targets, on splines.
inline MovingScene deforming_cloth() {
    GltfStage stage;
    constexpr int side = 8;
    std::vector<float> corners, lift, sway;
    std::vector<std::uint16_t> order;
    for (int row = 0; row <= side; ++row)
        for (int column = 0; column <= side; ++column) {
            const float u = float(column) / side, v = float(row) / side;
            corners.insert(corners.end(), {2 * u - 1, 0.3f + 1.4f * v, 0.2f});
            lift.insert(lift.end(), {0, 0.5f * std::sin(3 * u), 0.6f * std::sin(5 * u)});
            sway.insert(sway.end(), {0.6f * (1 - v), 0, 0.8f * std::sin(4 * v)});
            if (row == side || column == side) continue;
            for (const int corner : {0, 1, side + 1, side + 1, 1, side + 2})
                order.push_back(std::uint16_t(row * (side + 1) + column + corner));
        }
    const std::string mesh = R"({"primitives":[{"material":0,"attributes":{"POSITION":)" + stage.numbers(corners) +
                             R"(},"targets":[{"POSITION":)" + stage.numbers(lift) + R"(},{"POSITION":)" +
                             stage.numbers(sway) + R"(}],"indices":)" +
                             std::to_string(stage.text.accessor("SCALAR", 5123, order, order.size())) + "}]}";
    const std::string times = stage.numbers({0, 0.6f, 1}, "SCALAR");
    // of each key: what goes into it, its weights, and what goes out
    const std::string weights =
        stage.numbers({0, 0, 0, 0, 2, 0, 0, 1, 0.7f, -0.4f, 0, 1, 1, 0, 0, 0.9f, 0, 0}, "SCALAR");
    return {
        "DeformingCloth", "cloth.glb",
        stage.file(R"({"mesh":0})", 1, mesh, 1,
                   animation(R"({"input":)" + times + R"(,"output":)" + weights + R"(,"interpolation":"CUBICSPLINE"})",
                             R"({"sampler":0,"target":{"node":0,"path":"weights"}})"))};
}

/// pbrt: what has all light is a ball and a point that pass, while nothing else moves.
inline MovingScene moving_lamp() {
    return {"MovingLamp", "lamp.pbrt", R"(LookAt 0 1.2 4  0 0.6 0  0 1 0
Camera "perspective" "float fov" 50
WorldBegin
Material "diffuse" "rgb reflectance" [0.6 0.6 0.6]
Shape "trianglemesh" "point3 P" [-9 0 -9  9 0 -9  -9 0 9  9 0 9] "integer indices" [0 2 1  1 2 3]
AttributeBegin
  Translate 0 0.5 0
  Material "diffuse" "rgb reflectance" [0.7 0.3 0.2]
  Shape "sphere" "float radius" 0.5
AttributeEnd
AttributeBegin
  Translate -1.5 1.4 0.5
  ActiveTransform EndTime Translate 2.6 -0.5 0.4
  ActiveTransform All
  AreaLightSource "diffuse" "rgb L" [3.5 3 2.5]
  Shape "sphere" "float radius" 0.4
AttributeEnd
AttributeBegin
  Translate 1.2 1 1
  ActiveTransform EndTime Translate 0 1.5 -2
  ActiveTransform All
  LightSource "point" "rgb I" [2 3 4]
AttributeEnd
)"};
}

/// pbrt: a dozen instances, each on a way of its own, half of which turn.
inline MovingScene instance_swarm() {
    std::string text = R"(LookAt 0 1.5 4  0 1 0  0 1 0
Camera "perspective" "float fov" 50
WorldBegin
LightSource "infinite" "rgb L" [0.5 0.6 0.7]
LightSource "point" "point3 from" [2 4 3] "rgb I" [9 9 9]
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "trianglemesh" "point3 P" [-9 0 -9  9 0 -9  -9 0 9  9 0 9] "integer indices" [0 2 1  1 2 3]
ObjectBegin "chip"
  Material "diffuse" "rgb reflectance" [0.7 0.3 0.2]
  Shape "trianglemesh" "point3 P" [-.3 -.2 0  .3 -.2 0  0 .3 .1] "integer indices" [0 1 2]
  Translate 0 0.1 -0.2
  Shape "sphere" "float radius" 0.12
ObjectEnd
)";
    for (int i = 0; i < 12; ++i) {
        const double angle = i * 2.4, far = 0.3 + 0.1 * i;
        text += fmt::format(
            "AttributeBegin\nTranslate {} {} {}\nActiveTransform EndTime Translate {} {} 0.3 Rotate {} 0 1 0.2\n"
            "ActiveTransform All\nObjectInstance \"chip\"\nAttributeEnd\n",
            far * std::cos(angle), 1 + 0.5 * far * std::sin(angle), -0.5 + 0.1 * i, 0.5 * std::sin(angle),
            0.6 * std::cos(angle), i % 2 ? 70 : 0);
    }
    return {"InstanceSwarm", "swarm.pbrt", text};
}

inline std::vector<MovingScene> moving_scenes() {
    return {panning_camera(), spinning_wheel(), skinned_figure(), deforming_cloth(), moving_lamp(), instance_swarm()};
}

}  // namespace lightnet::test
