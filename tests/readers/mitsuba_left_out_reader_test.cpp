// Whatever Mitsuba's plugins know either changes the scene, or is named in a warning, or has no effect on any picture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>

#include "core/scene/data/identity.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::mitsuba_left_out_reader_test {
namespace {

using testing::HasSubstr;

const std::string ball = "<shape type='sphere'/>";

// 2 × 2 pixels of Radiance HDR
const std::string picture = [] {
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n";
    for (const auto& p : {"\x80\0\0\x81", "\0\x80\0\x81", "\0\0\x80\x81", "\x80\x80\x80\x81"})
        text += std::string(p, 4);
    return text;
}();
const std::string square =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 .5\n3 0 1 2\n";

/// A plugin, what stands around its parameters, and a parameter that is not as it is without it.
struct Parameter {
    std::string before, element, after;
    friend std::ostream& operator<<(std::ostream& out, const Parameter& p) { return out << p.before << p.element; }

    std::string name() const {
        const auto at = element.find("name='") + 6;
        return element.substr(at, element.find('\'', at) - at);
    }
};

class EveryParameter : public testing::TestWithParam<Parameter> {};

SceneData read(const std::string& elements) {
    return read_mitsuba(elements, {{"p.hdr", picture}, {"m.ply", square}, {"flat.spd", "360 1\n830 2\n"}});
}

bool same_camera(const CameraData& a, const CameraData& b) {
    return a.to_world == b.to_world && a.projection.index() == b.projection.index() && a.fov == b.fov &&
           a.screen == b.screen && a.lens_radius == b.lens_radius && a.focus_distance == b.focus_distance &&
           a.nearest == b.nearest && a.farthest == b.farthest;
}

TEST_P(EveryParameter, CountsOrIsNamed) {
    const auto& [before, element, after] = GetParam();
    const auto without = read(before + after), with = read(before + element + after);
    const bool counts = identity_of(without) != identity_of(with) || !same_camera(without.camera, with.camera) ||
                        without.film.width != with.film.width || without.film.crop != with.film.crop;
    if (counts) return;
    EXPECT_THAT(warnings_of(with), HasSubstr("'" + GetParam().name() + "'"));
}

std::string number(const std::string& name, const std::string& value) {
    return "<float name='" + name + "' value='" + value + "'/>";
}
std::string word(const std::string& name, const std::string& value) {
    return "<string name='" + name + "' value='" + value + "'/>";
}
std::string yes(const std::string& name) { return "<boolean name='" + name + "' value='true'/>"; }
std::string colour(const std::string& name) { return "<rgb name='" + name + "' value='.1 .2 .3'/>"; }
std::string checks(const std::string& name) {
    return "<texture type='checkerboard' name='" + name + "'><float name='color0' value='.25'/></texture>";
}
std::string moved(const std::string& name) {
    return "<transform name='" + name + "'><scale value='2'/><translate x='.25'/></transform>";
}

void add(std::vector<Parameter>& all, const std::string& before, const std::vector<std::string>& parameters,
         const std::string& after) {
    for (const auto& parameter : parameters) all.push_back({before, parameter, after});
}

std::vector<Parameter> of_bsdfs() {
    std::vector<Parameter> all;
    const auto bsdf = [&](const std::string& type, const std::vector<std::string>& parameters,
                          const std::string& inside = "") {
        add(all, "<shape type='rectangle'><bsdf type='" + type + "'>" + inside, parameters, "</bsdf></shape>");
    };
    const std::string diffuse = "<bsdf type='diffuse'/>";
    bsdf("diffuse", {colour("reflectance"), checks("reflectance")});
    bsdf("roughdiffuse", {colour("reflectance"), number("alpha", ".5"), checks("alpha")});
    bsdf("difftrans", {colour("transmittance")});
    for (const std::string type : {"dielectric", "thindielectric", "roughdielectric"})
        bsdf(type, {number("int_ior", "1.7"), word("ext_ior", "water"), colour("specular_reflectance"),
                    colour("specular_transmittance"), checks("specular_transmittance"), checks("int_ior")});
    for (const std::string type : {"conductor", "roughconductor"})
        bsdf(type, {word("material", "Au"), number("eta", ".3"), number("k", "2"), colour("specular_reflectance"),
                    number("ext_eta", "1.5") + number("eta", ".3"), word("material", "Nope")});
    for (const std::string type : {"roughconductor", "roughdielectric", "roughplastic"})
        bsdf(type, {number("alpha", ".4"), number("alpha_u", ".4"), number("alpha_v", ".4"), checks("alpha"),
                    word("distribution", "ggx"), word("distribution", "phong")});
    for (const std::string type : {"plastic", "roughplastic"})
        bsdf(type, {colour("diffuse_reflectance"), yes("nonlinear"), number("int_ior", "1.7"), number("ext_ior", "1.2"),
                    colour("specular_reflectance")});
    bsdf("phong",
         {number("exponent", "9"), colour("specular_reflectance"), colour("diffuse_reflectance"), checks("exponent")});
    bsdf("ward", {number("alpha_u", ".3"), number("alpha_v", ".3"), colour("specular_reflectance"),
                  colour("diffuse_reflectance"), checks("alpha_v")});
    for (const std::string type : {"principled", "principledthin"})
        for (const std::string name :
             {"roughness", "anisotropic", "spec_trans", "spec_tint", "sheen", "sheen_tint", "flatness"})
            bsdf(type, {number(name, ".3"), checks(name)});
    for (const std::string name : {"metallic", "clearcoat", "clearcoat_gloss", "specular"})
        bsdf("principled", {number(name, ".3"), checks(name)});
    bsdf("principled", {number("eta", "1.3"), number("eta", ".9"), colour("base_color"), checks("eta")});
    bsdf("principled", {number("specular", ".2")}, number("eta", "1.3"));
    bsdf("principledthin", {number("eta", "1.3"), number("diff_trans", ".3"), checks("diff_trans"), checks("eta")});
    bsdf("mask", {number("opacity", ".2"), checks("opacity")}, diffuse);
    bsdf("blendbsdf", {number("weight", ".2")}, diffuse + "<bsdf type='conductor'/>");
    bsdf("bumpmap", {number("scale", "3")}, checks("arbitrary") + diffuse);
    for (const std::string type : {"coating", "roughcoating"})
        bsdf(type,
             {number("int_ior", "1.7"), number("ext_ior", "1.2"), colour("sigma_a"), colour("specular_reflectance")},
             diffuse);
    bsdf("roughcoating", {number("alpha", ".4"), word("distribution", "as")}, diffuse);
    bsdf("hair", {number("eumelanin", ".4"), number("pheomelanin", ".4"), number("longitudinal_roughness", ".1"),
                  number("azimuthal_roughness", ".1"), number("scale_tilt", "3"), number("int_ior", "1.4"),
                  number("ext_ior", "1.2"), colour("sigma_a"), checks("sigma_a"), number("scale", "3")});
    bsdf("hair", {number("scale", "3")}, colour("sigma_a"));
    return all;
}

std::vector<Parameter> of_textures() {
    std::vector<Parameter> all;
    const auto texture = [&](const std::string& type, const std::vector<std::string>& parameters,
                             const std::string& inside = "") {
        add(all,
            "<shape type='rectangle'><bsdf type='diffuse'><texture name='reflectance' type='" + type + "'>" + inside,
            parameters, "</texture></bsdf></shape>");
    };
    texture("bitmap",
            {word("filter_type", "nearest"), word("wrap_mode", "mirror"), word("wrap_mode", "one"),
             word("wrap_mode_u", "clamp"), word("wrap_mode_v", "zero"), moved("to_uv"), number("uscale", "2"),
             number("vscale", "2"), number("uoffset", ".3"), number("voffset", ".3"), word("channel", "r"),
             number("exposure", "2")},
            word("filename", "p.hdr"));
    texture("checkerboard",
            {colour("color0"), colour("color1"), moved("to_uv"), number("uscale", "2"), number("line_width", "2")});
    texture("scale", {number("scale", ".5")}, checks("value"));
    return all;
}

std::vector<Parameter> of_emitters() {
    std::vector<Parameter> all;
    const auto emitter = [&](const std::string& type, const std::vector<std::string>& parameters,
                             const std::string& inside = "") {
        add(all, ball + "<emitter type='" + type + "'>" + inside, parameters, "</emitter>");
    };
    emitter("point", {colour("intensity"), moved("to_world"), "<point name='position' x='3'/>"});
    emitter("spot", {colour("intensity"), moved("to_world"), number("cutoff_angle", "40"), number("beam_width", "3"),
                     checks("texture")});
    emitter("projector", {number("scale", "3"), number("fov", "30"), word("focal_length", "30mm"), moved("to_world")},
            checks("irradiance"));
    emitter("directional", {colour("irradiance"), "<vector name='direction' x='3'/>",
                            "<transform name='to_world'><rotate x='1' angle='30'/></transform>"});
    emitter("constant", {colour("radiance")});
    emitter("envmap", {number("scale", "3"), "<transform name='to_world'><rotate x='1' angle='30'/></transform>"},
            word("filename", "p.hdr"));
    emitter("sunsky", {number("turbidity", "5"), number("stretch", "1.5"), number("scale", "2"),
                       number("sun_scale", "2"), number("sky_scale", "2"), number("sun_radius_scale", "2"),
                       number("resolution", "64"), number("hour", "11"), colour("albedo"), yes("complex_sun")});
    add(all, "<shape type='sphere'><emitter type='area'>",
        {colour("radiance"), checks("radiance"), number("tilt", "1")}, "</emitter></shape>");
    return all;
}

std::vector<Parameter> of_shapes() {
    std::vector<Parameter> all;
    const auto shape = [&](const std::string& type, const std::vector<std::string>& parameters,
                           const std::string& inside = "") {
        add(all, "<shape type='" + type + "'>" + inside, parameters, "</shape>");
    };
    shape("sphere", {number("radius", "3"), "<point name='center' x='3'/>", moved("to_world"), yes("flip_normals")});
    for (const std::string type : {"rectangle", "disk", "cube"}) shape(type, {moved("to_world"), yes("flip_normals")});
    shape("cylinder",
          {number("radius", "3"), "<point name='p0' x='3'/>", "<point name='p1' x='3'/>", yes("flip_normals")});
    shape("ply",
          {yes("face_normals"), yes("flip_normals"), moved("to_world"), number("max_smooth_angle", "30"), yes("srgb"),
           "<boolean name='recompute_vertex_normals' value='true'/>"},
          word("filename", "m.ply"));
    return all;
}

std::vector<Parameter> of_sensors() {
    std::vector<Parameter> all;
    const auto sensor = [&](const std::string& type, const std::vector<std::string>& parameters,
                            const std::string& inside = "") {
        add(all, ball + "<sensor type='" + type + "'>" + inside, parameters, "</sensor>");
    };
    const std::string behind = "<transform name='to_world'><translate z='-3'/></transform>";
    for (const std::string type : {"perspective", "thinlens"})
        sensor(type,
               {number("fov", "33"), word("focal_length", "30mm"), number("near_clip", "3"),
                number("principal_point_offset_x", ".1"), number("principal_point_offset_y", ".1"), word("srf", "x")},
               behind);
    sensor("perspective", {word("fov_axis", "y"), word("fov_axis", "diagonal")}, number("fov", "40"));
    sensor("perspective", {number("far_clip", "2")}, behind);
    sensor("thinlens", {number("aperture_radius", ".1"), number("focus_distance", "3")});
    sensor("orthographic", {moved("to_world"), number("near_clip", "3"), number("principal_point_offset_x", ".1")});
    add(all, ball + "<sensor type='perspective'><film type='hdrfilm'>",
        {"<integer name='width' value='99'/>", "<integer name='crop_width' value='99'/>"}, "</film></sensor>");
    return all;
}

INSTANTIATE_TEST_SUITE_P(Bsdfs, EveryParameter, testing::ValuesIn(of_bsdfs()));
INSTANTIATE_TEST_SUITE_P(Textures, EveryParameter, testing::ValuesIn(of_textures()));
INSTANTIATE_TEST_SUITE_P(Emitters, EveryParameter, testing::ValuesIn(of_emitters()));
INSTANTIATE_TEST_SUITE_P(Shapes, EveryParameter, testing::ValuesIn(of_shapes()));
INSTANTIATE_TEST_SUITE_P(Sensors, EveryParameter, testing::ValuesIn(of_sensors()));

TEST(MitsubaMedia, OfUnknownTypesAreNamed) {
    EXPECT_THAT(warnings_of(read("<shape type='sphere'><bsdf type='null'/><medium name='interior' type='homogenous'/>"
                                 "</shape>")),
                HasSubstr("medium 'homogenous' is not supported (did you mean 'homogeneous'?)"));
    EXPECT_THAT(warnings_of(read("<shape type='sphere'/><medium type='homogeneous' id='fog'/>")),
                HasSubstr("<medium> fills nothing"));
}

// Whole plugins that are not supported go by their names.
TEST(MitsubaPlugins, ThatAreNotSupportedAreNamed) {
    for (const std::string type : {"measured_polarized", "hk", "irawan", "sssbrdf"})
        EXPECT_THAT(warnings_of(read("<shape type='sphere'><bsdf type='" + type + "'/></shape>")),
                    HasSubstr("bsdf '" + type + "' is not supported"));
    for (const std::string type : {"hair", "deformable"})
        EXPECT_THAT(warnings_of(read(ball + "<shape type='" + type + "'/>")),
                    HasSubstr("shape '" + type + "' is not supported"));
    for (const std::string type : {"collimated", "directionalarea", "volumelight"})
        EXPECT_THAT(warnings_of(read(ball + "<emitter type='" + type + "'/>")),
                    HasSubstr("emitter '" + type + "' is not supported"));
    for (const std::string type : {"radiancemeter", "telecentric", "irradiancemeter", "distant", "batch"})
        EXPECT_THAT(warnings_of(read(ball + "<sensor type='" + type + "'/>")), HasSubstr("sensor '" + type + "'"));
    for (const std::string type : {"wireframe", "curvature", "gridtexture", "volume"})
        EXPECT_THAT(warnings_of(read("<shape type='sphere'><bsdf type='diffuse'><texture name='reflectance' type='" +
                                     type + "'/></bsdf></shape>")),
                    HasSubstr("texture '" + type + "' is not supported"));
}

}  // namespace
}  // namespace lightnet::test::mitsuba_left_out_reader_test
