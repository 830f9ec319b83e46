#include "core/base/error.hpp"
#include "core/readers/read_scene.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/support/light_profile_text.hpp"
#include "tests/support/memory_files.hpp"

namespace lightnet::fuzz {
namespace {

template <void (*use)(SceneData)>
void read(std::span<const std::byte> bytes) {
    test::MemoryFiles files;
    files.add("scene.pbrt", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    files.add("part.pbrt", "Include \"scene.pbrt\"\n");
    files.add("mesh.ply", meshes().seeds().front());
    files.add("flat.ply",
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
              "property float u\nproperty float v\nelement face 1\nproperty list uchar int vertex_indices\n"
              "end_header\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n");
    files.add("even.bsdf", measured().seeds().front());
    files.add("lamp.ies", test::light_profile("2 1", "0 90 0 1 1"));
    files.add("picture.hdr",
              std::string("#?RADIANCE\n\n-Y 1 +X 2\n") + std::string("\x80\x40\x20\x81\x80\x40\x20\x81", 8));
    try {
        use(read_scene(files, "scene.pbrt"));
    } catch (const UserError&) {
    } catch (const Error&) {
    }
}

std::vector<std::string> seeds() {
    return {
        R"(LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" [ 40 ]
Film "rgb" "integer xresolution" 64 "integer yresolution" [ 32 ]
Sampler "independent" "integer pixelsamples" [ 4 ]
Integrator "path"
WorldBegin
MakeNamedMaterial "wall" "string type" "diffuse" "rgb reflectance" [ .5 .6 .7 ]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 5 5 5 ] "bool twosided" true
  Translate 0 1 0
  Shape "sphere" "float radius" .5
AttributeEnd
NamedMaterial "wall"
Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0 ] "integer indices" [ 0 1 2 ] "normal N" [ 0 0 1 0 0 1 0 0 1 ]
)",
        R"(Transform [ 1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1 ]
Camera "perspective" "float fov" 90 "string fovdist" "x" # a comment
WorldBegin
Texture "red" "spectrum" "constant" "rgb value" [ 1 0 0 ]
Texture "half" "spectrum" "scale" "texture tex" "red" "float scale" .5
Material "coateddiffuse" "texture reflectance" "half" "float roughness" 0.1
ObjectBegin "thing"
  Shape "plymesh" "string filename" "mesh.ply"
  Shape "bilinearmesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 0 ]
ObjectEnd
AttributeBegin
  Rotate 30 0 0 1
  Scale 2 2 -1
  ReverseOrientation
  ObjectInstance "thing"
AttributeEnd
Material "conductor" "spectrum eta" "metal-Cu-eta" "spectrum k" "metal-Cu-k"
Shape "disk" "float radius" 2
Material "measured" "string filename" "even.bsdf"
Shape "sphere"
Material "hair" "rgb reflectance" [ .2 .5 .9 ] "float beta_m" .4 "float alpha" 3
Shape "curve" "point3 P" [ 0 0 0 0 0 1 0 1 2 0 1 3 ] "float width" .1
Material "dielectric" "float eta" 1.5
Shape "cylinder" "float zmin" -1 "float zmax" 1
LightSource "infinite" "blackbody L" 6500 "float scale" .1
Include "part.pbrt"
)",
        R"(Film "rgb" "float whitebalance" 5000 "float iso" 200 "float cropwindow" [ 0 1 .25 1 ]
Camera "orthographic" "float screenwindow" [ -1 1 -1 1 ] "float lensradius" .1 "float focaldistance" 3
ColorSpace "rec2020"
WorldBegin
Texture "bits" "float" "imagemap" "string filename" "picture.hdr" "string wrap" "clamp" "bool invert" true
Texture "board" "spectrum" "checkerboard" "rgb tex1" [ 1 0 0 ] "rgb tex2" [ 0 1 0 ] "float uscale" 4
Texture "four" "spectrum" "bilerp" "rgb v00" [ 0 0 0 ] "rgb v11" [ 1 1 1 ]
Texture "both" "spectrum" "mix" "texture tex1" "board" "texture tex2" "four" "texture amount" "bits"
MakeNamedMaterial "a" "string type" "coatedconductor" "float interface.roughness" .1 "spectrum conductor.eta" "metal-Au-eta"
  "spectrum conductor.k" "metal-Au-k" "texture displacement" "bits"
MakeNamedMaterial "b" "string type" "diffusetransmission" "texture reflectance" "both" "string normalmap" "picture.hdr"
MakeNamedMaterial "c" "string type" "mix" "string materials" [ "a" "b" ] "texture amount" "bits"
NamedMaterial "c"
Shape "loopsubdiv" "integer levels" 2 "integer indices" [ 0 1 2  0 2 3  0 3 1  1 3 2 ] "point3 P" [ 0 0 0 1 0 0 0 1 0 0 0 1 ]
Shape "bilinearmesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 1 ] "texture alpha" "bits"
Shape "plymesh" "string filename" "flat.ply" "texture displacement" "bits" "float edgelength" .5
LightSource "point" "rgb I" [ 1 2 3 ] "float power" 5
LightSource "spot" "float coneangle" 30 "point3 from" [ 0 0 1 ]
LightSource "distant" "float illuminance" 3
LightSource "infinite" "string filename" "picture.hdr" "float illuminance" 2
LightSource "projection" "string filename" "picture.hdr"
LightSource "goniometric" "rgb I" [ 1 2 3 ] "float power" 5
LightSource "goniometric" "string filename" "lamp.ies" "float power" 5
MakeNamedMedium "m" "string type" "homogeneous" "rgb sigma_a" [ 1 1 1 ] "rgb sigma_s" [ 0 0 0 ]
MediumInterface "" "m"
AreaLightSource "diffuse" "string filename" "picture.hdr" "float power" 10
Shape "disk" "float alpha" 0
)",
        R"(Film "image" "integer xresolution" 8 "float scale" 2
Camera "environment"
Sampler "02sequence" "integer pixelsamples" 4
WorldBegin
Texture "r" "float" "imagemap" "string filename" "picture.hdr" "bool gamma" "false"
Texture "c" "color" "scale" "color tex1" [ .5 1 .25 ] "xyz tex2" [ .5 .5 1 ]
Material "uber" "texture Kd" "c" "texture roughness" "r" "color Kr" [ .1 .1 .1 ] "rgb opacity" [ .5 .5 .5 ]
Shape "heightfield" "integer nu" 2 "integer nv" 2 "float Pz" [ 0 1 0 1 ]
MakeNamedMaterial "a" "string type" "plastic" "float uroughness" .1 "texture bumpmap" "r"
MakeNamedMaterial "b" "string type" "translucent" "bool remaproughness" "false"
Material "mix" "string namedmaterial1" "a" "string namedmaterial2" "b" "color amount" [ .3 .3 .3 ]
Shape "cone" "float phimax" 200
Material "fourier" "string bsdffile" "roughgold_alpha_0.2.bsdf"
Shape "hyperboloid" "point p1" [ 1 0 0 ] "point p2" [ 1 1 1 ]
Material "substrate" "float roughness" .1
Shape "paraboloid"
Material "glass" "float vroughness" .2
Shape "trianglemesh" "point P" [ 0 0 0 1 0 0 0 1 0 ] "float uv" [ 0 0 1 0 0 1 ] "integer indices" [ 0 1 2 ]
LightSource "infinite" "string mapname" "picture.hdr" "color scale" [ 1 2 3 ] "integer nsamples" 4
LightSource "goniometric" "string mapname" "picture.hdr" "blackbody I" [ 4000 2 ]
LightSource "spot" "color I" [ 1 1 1 ] "float coneangle" 20
AreaLightSource "area" "spectrum L" [ 400 1 700 2 ]
Material "disney"
Shape "sphere"
WorldEnd
)",
    };
}

}  // namespace

Target scenes() { return {"scenes", read<drop>, seeds}; }
Target rays_pbrt() { return {"rays_pbrt", read<render>, seeds, 20}; }

}  // namespace lightnet::fuzz
