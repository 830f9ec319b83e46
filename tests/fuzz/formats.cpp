#include <zlib.h>

#include <stdexcept>

#include "core/base/error.hpp"
#include "core/readers/common/grid_file.hpp"
#include "core/readers/common/iso_surface.hpp"
#include "core/readers/common/light_profile.hpp"
#include "core/readers/common/measurements.hpp"
#include "core/readers/common/volume_file.hpp"
#include "core/readers/mitsuba/curves.hpp"
#include "core/readers/mitsuba/serialized.hpp"
#include "core/readers/read_scene.hpp"
#include "core/scene/bsdf/measured.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/support/gltf_text.hpp"
#include "tests/support/light_profile_text.hpp"
#include "tests/support/measured_numbers.hpp"
#include "tests/support/packed_meshes.hpp"
#include "tests/support/scene_text.hpp"
#include "tests/support/vdb_bytes.hpp"

namespace lightnet::fuzz {
namespace {

std::string text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

const std::string dot = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string("\x80\x80\x80\x81", 4);
const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

// Numbers above and below 0 at the corners of a cube.
const std::string solid = "VOL\3" + test::raw(1, 2, 2, 2, 1) + test::raw(0.f, 0.f, 0.f, 1.f, 1.f, 1.f) +
                          test::raw(-1.f, 1.f, 1.f, 1.f, 1.f, 2.f, 1.f, -1.f);

using Use = void (*)(SceneData);

void attempt(const std::string& name, const std::string& text, test::MemoryFiles files, Use use,
             const SceneConstants& constants = {}) {
    try {
        files.add(name, text);
        use(read_scene(files, name, constants));
    } catch (const UserError&) {
    } catch (const Error&) {
    }
}

template <Use use>
void read_mitsuba(std::span<const std::byte> bytes) {
    test::MemoryFiles files{{"a.obj", square},
                            {"p.hdr", dot},
                            {"a.ply", meshes().seeds().front()},
                            {"a.bsdf", measured().seeds().front()},
                            {"d.vol", solid},
                            {"more.xml", "<scene><include filename='scene.xml'/><shape type='cube'/></scene>"}};
    attempt("scene.xml", text_of(bytes), std::move(files), use);
}

std::vector<std::string> mitsuba_seeds() {
    return {
        R"(<scene version="3.0.0"><default name="n" value="2"/>
<sensor type="thinlens"><float name="fov" value="40"/><float name="aperture_radius" value=".1"/><string name="fov_axis" value="y"/>
<transform name="to_world"><lookat origin="0,0,5" target="0 0 0" up="0,1,0"/></transform>
<film type="hdrfilm"><integer name="width" value="64"/><integer name="height" value="$n"/></film></sensor>
<bsdf type="twosided" id="a"><bsdf type="principled"><rgb name="base_color" value="#80ff00"/><float name="clearcoat" value=".5"/></bsdf></bsdf>
<texture type="checkerboard" id="t"><transform name="to_uv"><scale x="4" y="$n"/><rotate angle="30"/></transform></texture>
<shape type="obj"><string name="filename" value="a.obj"/><ref id="a"/><emitter type="area"><blackbody name="radiance" temperature="3000K"/></emitter></shape>
<shape type="sphere"><bsdf type="blendbsdf"><ref name="weight" id="t"/><ref id="a"/><bsdf type="plastic"/></bsdf></shape>
<include filename="more.xml"/></scene>)",
        R"(<scene version="0.6.0"><shape type="shapegroup" id="g"><shape type="ply"><string name="filename" value="a.ply"/></shape></shape>
<shape type="instance"><ref id="g"/><transform name="toWorld"><rotate y="1" angle="30"/><matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"/></transform></shape>
<shape type="cube"><bsdf type="measured"><string name="filename" value="a.bsdf"/></bsdf></shape>
<shape type="cylinder"><point name="p0" x="1"/><bsdf type="bumpmap"><texture type="scale"><texture type="bitmap"><string name="filename" value="p.hdr"/>
<float name="uscale" value="2"/></texture><float name="scale" value="3"/></texture><bsdf type="roughconductor"><string name="material" value="Au"/></bsdf></bsdf></shape>
<shape type="disk"><bsdf type="mixturebsdf"><string name="weights" value=".5,.2"/><bsdf type="diffuse"><spectrum name="reflectance" value="400:.1 700:.5"/></bsdf>
<bsdf type="dielectric"><string name="intIOR" value="water"/></bsdf></bsdf></shape>
<shape type="merge"><shape type="cube"><bsdf type="mask"><float name="opacity" value=".5"/><bsdf type="null"/></bsdf><emitter type="area"/></shape></shape>
<medium id="m" type="heterogeneous"><volume name="density" type="constvolume"/></medium><shape type="cube"><bsdf type="null"/><ref name="interior" id="m"/></shape>
<shape type="sphere"><bsdf type="hair"><rgb name="sigma_a" value=".1,.2,.3"/><float name="scale" value="2"/></bsdf></shape>
<shape type="sdfgrid"><string name="filename" value="d.vol"/></shape>
<shape type="heightfield"><texture type="checkerboard"/><integer name="width" value="3"/><integer name="height" value="2"/></shape>
<emitter type="envmap"><string name="filename" value="p.hdr"/></emitter><emitter type="projector"><texture name="irradiance" type="bitmap">
<string name="filename" value="p.hdr"/></texture></emitter><emitter type="spot"/><emitter type="sun"/></scene>)"};
}

template <Use use>
void read_gltf(std::span<const std::byte> bytes) {
    const std::string text = text_of(bytes);
    attempt(
        text.starts_with("glTF") ? "scene.glb" : "scene.gltf", text, {{"p.hdr", dot}, {"b.bin", std::string(80, '\1')}},
        use,
        text.find("animations") == text.npos ? SceneConstants{} : SceneConstants{{std::string(time_constant), "0.3"}});
}

/// Turns, morphs by a spline, and what a pointer names.
std::string moving_seed() {
    test::GltfText text = test::triangle_text();
    text.vectors("SCALAR", {0, 1});
    text.vectors("VEC4", {0, 0, 0, 1, 0, 0, 1, 0});
    text.vectors("SCALAR", {0, 1, 0, 0, 2, 0});
    return text.file(
        R"("nodes":[{"mesh":0,"weights":[1]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":0}]}]}],
"materials":[{"alphaCutoff":0.5}],"animations":[{"name":"a","samplers":[{"input":1,"output":2,"interpolation":"STEP"},{"input":1,"output":3,"interpolation":"CUBICSPLINE"}],
"channels":[{"sampler":0,"target":{"node":0,"path":"rotation"}},{"sampler":1,"target":{"node":0,"path":"weights"}},
{"sampler":1,"target":{"path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":"/materials/0/alphaCutoff"}}}}]}],)");
}

/// Morph targets, a skin, a hidden node, variants, two sets of texture coordinates, and all that materials can be.
std::string posed_seed() {
    test::GltfText text = test::triangle_text();
    text.vectors("VEC2", {0, 0, 1, 0, 0, 1});
    text.accessor<std::uint8_t>("VEC4", 5121, std::vector<std::uint8_t>(12), 3);
    text.vectors("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    text.vectors("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    return text.file(R"("nodes":[{"mesh":0,"skin":0,"weights":[0.5,1]},{"translation":[0,0,1],"children":[2]},
{"mesh":0,"extensions":{"KHR_node_visibility":{"visible":false}}}],"skins":[{"joints":[1],"inverseBindMatrices":4}],
"extensions":{"KHR_materials_variants":{"variants":[{"name":"a"}]}},"images":[{"uri":"p.hdr"}],"textures":[{"source":0}],
"meshes":[{"weights":[1,0],"primitives":[{"material":0,"attributes":{"POSITION":0,"TEXCOORD_0":1,"TEXCOORD_1":1,"JOINTS_0":2,"WEIGHTS_0":3},
"targets":[{"POSITION":0},{"POSITION":0,"TEXCOORD_0":1}],"extensions":{"KHR_materials_variants":{"mappings":[{"material":0,"variants":[0]}]}}}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1}},"normalTexture":{"index":0},"extensions":{
"KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatNormalTexture":{"index":0}},"KHR_materials_anisotropy":{"anisotropyStrength":1,
"anisotropyTexture":{"index":0}},"KHR_materials_iridescence":{"iridescenceFactor":1,"iridescenceThicknessTexture":{"index":0}},
"KHR_materials_transmission":{"transmissionFactor":0.5},"KHR_materials_volume":{"thicknessFactor":1},"KHR_materials_dispersion":{"dispersion":5},
"KHR_materials_diffuse_transmission":{"diffuseTransmissionFactor":0.5}}}],)");
}

/// One mesh of Draco's, one of meshopt's.
std::string packed_seed() {
    test::GltfText text;
    const auto packed = text.view(test::packed_by_draco(4, true));
    text.empty_accessor("VEC3", 5126, 10);
    text.empty_accessor("VEC4", 5121, 10, R"(,"normalized":true)");
    const auto view = [&](const test::PackedView& made) {
        const auto at = text.put(made.bytes);
        return text.view(made.json(at), nullptr);
    };
    text.accessor("VEC3", 5126, view(test::packed_corners()), 4);
    text.accessor("SCALAR", 5123, view(test::packed_order()), 6);
    return text.file(
        R"("nodes":[{"mesh":0},{"mesh":1}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"COLOR_0":1},
"extensions":{"KHR_draco_mesh_compression":{"bufferView":)" +
        std::to_string(packed) + R"(,"attributes":{"POSITION":0,"COLOR_0":1}}}}]},
{"primitives":[{"attributes":{"POSITION":2},"indices":3}]}],)");
}

std::vector<std::string> gltf_seeds() {
    const std::string json =
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"children":[2]},{"mesh":0,
"translation":[1,2,3],"rotation":[0,0,0,1]},{"camera":0,"extensions":{"KHR_lights_punctual":{"light":0}}}],"cameras":[{"type":"perspective","perspective":{"yfov":1}}],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","spot":{}}]}},"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0,"mode":5}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{"rotation":1}}}},"alphaMode":"BLEND",
"extensions":{"KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":2}}}],"textures":[{"source":0,"sampler":0}],"samplers":[{"wrapS":33071}],
"images":[{"uri":"p.hdr"}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":1,
"componentType":5121},"values":{"bufferView":0}}},{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],"buffers":[{"byteLength":42)";
    const std::string binary = std::string(36, '\1') + std::string("\0\1\2\0\1\2", 6);
    return {
        posed_seed(),
        packed_seed(),
        moving_seed(),
        test::glb(json + "}]}", binary),
        json + R"(,"uri":"b.bin"}]})",
        R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],"bufferViews":[{"buffer":0,
"byteLength":36,"byteStride":12}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}]})"};
}

/// The library is what stands behind the first NUL.
template <Use use>
void read_obj(std::span<const std::byte> bytes) {
    const std::string text = text_of(bytes);
    const auto border = std::min(text.find('\0'), text.size());
    attempt("scene.obj", text.substr(0, border),
            {{"m.mtl", text.substr(std::min(border + 1, text.size()))}, {"p.hdr", dot}, {"c.rfl", "400 .5 700 .7\n"}},
            use);
}

std::vector<std::string> obj_seeds() {
    return {
        "mtllib m.mtl\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv .5 .2 0\nvt 0 0\nvn 0 0 1\ns 1\nusemtl a\nf 1/1/1 2//1 -2 -1 "
        "\\\n 3\nl 1 2\n" +
            std::string(1, '\0') +
            "newmtl a\nKd .5 .5 .5\nmap_Kd -s 2 2 -o 1 p.hdr\nPr .3\nd .5\nKe spectral C.RFL 2\nTf spectral "
            "m.mtl\nnewmtl b\nillum 7\nNi 1.5\nbump "
            "-bm 2 p.hdr\n",
        square + "g x\no y\nusemtl none\nf 1 2 3\n",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nvt 0 0\nf 1/1 2/1 3/1 4/1\nf 1 5 6 2\nf 5 1 4\nt crease "
        "4/2/0 "
        "0 1 0 4 9 2\nt corner 1/1/0 2 1.5\nt hole 1/0/0 2\nt interpolateboundary 1/0/0 1\nt creasemethod 0/0/1 "
        "chaikin\n",
        "\xEF\xBB\xBFmtllib my m.mtl M.MTL C:\\m.mtl # all\n" + square + "usemtl a\nf 1/1/1 2/-1/-1 3/9/9\n" +
            std::string(1, '\0') +
            "\xEF\xBB\xBFnewmtl a\nmap_Kd -imfchan r -texres 9 C:\\lost\\P.HDR\nmap_Ke gone.png\nbump m.mtl\nmap_d\n"};
}

void read_serialized(std::span<const std::byte> bytes) {
    for (const std::size_t index : {0, 1}) try {
            bool flat = false;
            (void)lightnet::mitsuba::read_serialized(bytes, index, flat);
        } catch (const Error&) {
        }
}

std::vector<std::string> serialized_seeds() {
    using test::raw;
    const std::string body = raw(std::uint32_t{0x1001}) + '\0' + raw(std::uint64_t{3}, std::uint64_t{1}) +
                             std::string(72, '\1') + raw(0u, 1u, 2u);
    const auto packed = [&](int level) {
        uLongf size = compressBound(body.size());
        std::string result(size, '\0');
        compress2(reinterpret_cast<Bytef*>(result.data()), &size, reinterpret_cast<const Bytef*>(body.data()),
                  body.size(), level);
        result.resize(size);
        return raw(std::uint16_t{0x041C}, std::uint16_t{4}) + result;
    };
    const std::string one = packed(0);  // damage reaches what is not packed
    return {one + packed(6) + raw(std::uint64_t{0}, std::uint64_t{one.size()}, 2u), packed(6)};
}

void read_strands(std::span<const std::byte> bytes) {
    for (const bool linear : {false, true}) try {
            const Curves curves = lightnet::mitsuba::read_curves(text_of(bytes), linear, {});
            if (!curves.fault().empty()) throw std::logic_error("strands that can't be built");
            for (const float at : {0.0f, 0.7f, 1.0f}) (void)surface_of(curves.at(0, at), 1.5f);
        } catch (const Error&) {
        }
}

std::vector<std::string> strand_seeds() {
    return {"0 0 0 .1\n0 0 1 .1\n 0 1 2 1e-1\r\n+1 0 3 0\n\n1 2 3 4\n5 6 7 8\n9 10 11 12\n13 14 15 16",
            "0 0 0 1\n1 0 0 1\n\n\t\n1 1 1 1\n1 1 1 1"};
}

void read_volume(std::span<const std::byte> bytes) {
    try {
        const auto volume = read_volume_file(bytes, {});
        for (const Vec3 place : {Vec3{0, 0, 0}, Vec3{0.3f, 0.9f, 0.5f}, Vec3{1, 1, 1}, Vec3{-1e30f, 1e30f, 0}})
            if (!finite(volume.grid->at(place))) throw std::logic_error("a volume of impossible density");
    } catch (const Error&) {
    }
}

void read_solid(std::span<const std::byte> bytes) {
    try {
        const auto grid = read_volume_file(bytes, {}, VolumeNumbers::any).grid;
        const auto mesh = grid->channels == 1 ? iso_surface(*grid, 1 << 16) : std::nullopt;
        if (mesh && !mesh->fault().empty()) throw std::logic_error("a surface that can't be used");
    } catch (const Error&) {
    }
}

void read_volume_or_solid(std::span<const std::byte> bytes) {
    read_volume(bytes);
    read_solid(bytes);
}

std::vector<std::string> volume_seeds() {
    using test::raw;
    const auto header = [](int type, int channels) {
        return "VOL\3" + raw(type, 2, 1, 2, channels) + raw(0.f, 0.f, 0.f, 1.f, 1.f, 1.f);
    };
    return {solid, header(1, 1) + raw(0.f, 1.f, .5f, 2.f),
            header(3, 3) + std::string("\0\1\2\3\4\5\6\7\x8\x9\xA\xB", 12)};
}

void read_sparse_grid(std::span<const std::byte> bytes) {
    try {
        const auto found = read_grid(bytes, "density");
        if (!found) return;
        Medium medium;
        medium.extinction = {{1, 1, 1}, found->grid, found->to_grid};
        if (!medium.fault().empty()) throw std::logic_error("a grid that can't be used");
        for (const Vec3 place : {Vec3{0, 0, 0}, Vec3{0.3f, 0.9f, 0.5f}, Vec3{1, 1, 1}, Vec3{-1e30f, 1e30f, 0}})
            if (!finite(found->grid->at(place))) throw std::logic_error("a grid of impossible density");
    } catch (const Error&) {
    }
}

std::vector<std::string> sparse_grid_seeds() {
    test::NanovdbPoints grid;
    grid.points = {{{0, 0, 0}, 1}, {{1, 7, 2}, 0.5f}, {{-9, 3, 130}, 2}};
    return {test::nanovdb_file({grid}, 1),    test::nanovdb_file({grid}, 2),     test::nanovdb_file({grid}),
            test::vdb_file({grid}, {2}),      test::vdb_file({grid}, {6, true}), test::vdb_file({grid}, {3}),
            test::vdb_file({grid, grid}, {2})};
}

void read_measured(std::span<const std::byte> bytes) {
    try {
        const auto measured = read_measurement(bytes);
        const MeasuredBsdf bsdf{measured.get()};
        for (const Vec3 o : {Vec3{0, 0, 1}, normalize(Vec3{1, 2, 1}), normalize(Vec3{-1, 0.5f, -2})})
            for (const Vec2 u : {Vec2{0, 0}, Vec2{0.3f, 0.6f}, Vec2{0.999999f, 0.999999f}}) {
                (void)bsdf.sample(o, 0, u, lobe::all);
                (void)bsdf.evaluate(o, {-o.x, -o.y, o.z}, lobe::all);
            }
    } catch (const Error&) {
    }
}

std::vector<std::string> measured_seeds() {
    auto plain = test::even_numbers({1, 1, 1});
    plain.times_facets = false;
    return {test::tensor_file_of(plain), test::tensor_file_of(test::ggx_numbers(0.3f, 0.3f, {1, 1, 1}, 2), {400, 600})};
}

void read_profile(std::span<const std::byte> bytes) {
    try {
        const auto profile = read_light_profile(text_of(bytes), [&](const std::string& name) {
            return std::optional<std::string>(name + "\n2 0 90 1 .5");
        });
        (void)profile.tilt.factor(Matrix{}, normalize(Vec3{1, 2, -2}));
        for (const Vec3 d : {Vec3{0, 0, -1}, Vec3{0, 0, 1}, normalize(Vec3{1, 2, -1}), normalize(Vec3{-1, -0.5f, 2})})
            if (const float candela = profile.towards(d); !(candela >= 0 && candela < 1e31f))
                throw std::logic_error("a profile of impossible light");
    } catch (const Error&) {
    }
}

std::vector<std::string> profile_seeds() {
    return {test::light_profile("3 2", "0 45 90\n0 180\n9 5 1\n8 4 0"),
            test::light_profile("2 4", "0 180 0 90 180 270 1 2 3 4 5 6 7 8"),
            test::light_profile("3 2", "-90 0 90 0 60 1 2 3 4 5 6", 2),
            "A LAMP\nTILT=INCLUDE\n1\n2\n0 90\n1 .9\n1 100 1 2 1 3 1 0 0 0\n1 1 9\n-10 10\n0\n7 7\n",
            "TILT=3\n1 100 1 2 1 1 1 0 0 0\n1 1 9\n0 90\n0\n7 7\n"};
}

}  // namespace

Target mitsuba() { return {"mitsuba", read_mitsuba<drop>, mitsuba_seeds}; }
Target rays_mitsuba() { return {"rays_mitsuba", read_mitsuba<render>, mitsuba_seeds, 20}; }
Target gltf() { return {"gltf", read_gltf<drop>, gltf_seeds}; }
Target rays_gltf() { return {"rays_gltf", read_gltf<render>, gltf_seeds, 20}; }
Target obj() { return {"obj", read_obj<drop>, obj_seeds}; }
Target rays_obj() { return {"rays_obj", read_obj<render>, obj_seeds, 20}; }
Target measured() { return {"measured", read_measured, measured_seeds}; }
Target profiles() { return {"profiles", read_profile, profile_seeds}; }
Target strands() { return {"strands", read_strands, strand_seeds}; }
Target volumes() { return {"volumes", read_volume_or_solid, volume_seeds}; }
Target sparse_volumes() { return {"sparse_volumes", read_sparse_grid, sparse_grid_seeds}; }
Target serialized() { return {"serialized", read_serialized, serialized_seeds}; }

}  // namespace lightnet::fuzz
