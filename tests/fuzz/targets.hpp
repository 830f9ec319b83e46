// Everything that reads what strangers send or write, as functions of plain bytes.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/scene/data/scene_data.hpp"

namespace lightnet::fuzz {

/// Reads bytes in one way. Returns when they were read or properly refused; anything else is a bug.
struct Target {
    std::string name;
    void (*read)(std::span<const std::byte>);
    /// Sound inputs, from which damaged ones are made.
    std::vector<std::string> (*seeds)();
    /// How often it is tried less than one that only reads.
    std::size_t cost = 1;
};

/// What is done with a scene that could be read.
void drop(SceneData scene);
/// A picture of 2 x 2 pixels, all the way from the camera to the light and back.
void render(SceneData scene);

/// Packets: the header's 68 bytes, then the body. Each is also read with its magic, size and checksum put right, or
/// nothing would ever come past them.
Target packets();
/// Scenes in the language of pbrt, beside which a mesh lies.
Target scenes();
/// PLY files.
Target meshes();
/// JSON of graphs, plans, jobs and hosts. What is accepted must come back the same.
Target texts();

/// Scenes of Mitsuba, beside which meshes, a picture and another part lie.
Target mitsuba();
/// Scenes in glTF, .gltf or .glb.
Target gltf();
/// OBJ files with a library of materials.
Target obj();
/// Mitsuba's packed meshes.
Target serialized();
/// Hair of Mitsuba's text files.
Target strands();
/// Measured materials, and light on those that could be read.
Target measured();
/// Profiles of luminaires, asked for what they send into some directions.
Target profiles();
Target volumes();
/// NanoVDB's files.
Target sparse_volumes();
/// Pictures of the usual kinds, and of the others.
Target pictures();
Target rare_pictures();

/// Pictures that this project has written, with layers, mattes and words.
Target films();
/// Names of shapes, as scenes have them, and the manifest of a matte that tells them. Each that is UTF-8 must be there.
Target manifests();

/// Jobs, as a launcher that nobody knows sends them: read, checked, and laid out. What is accepted must come back the
/// same.
Target jobs();
/// Checkpoints, whose hash is put right, taken up by a film.
Target checkpoints();
/// Graph files and hosts files in Lua, and what check() says to them.
Target graphs();

/// Lists of keys, and keys themselves. What is accepted must come back the same.
Target keys();
/// Packets as they come to a host's door that asks for keys: a byte says from whom, the rest is the header.
Target gates();

/// Packets in any order, as they come to a daemon that asks for no keys, with jobs, plans and files.
Target conversations();

/// What comes to the server of a watched run: HTTP, and a WebSocket.
Target watched();
/// What comes from there to `watch`, or from whoever else listens.
Target lines();

/// The same scenes, read and rendered: what comes between the file and the ray.
Target rays_pbrt();
Target rays_mitsuba();
Target rays_gltf();
Target rays_obj();
/// Operators in Lua, with questions about a small scene.
Target customs();
/// Files that runs keep of what they have learnt, and recipes of a cache.
Target kept();
/// Reports of runs (x.run.json), as `explain` and `watch` read them.
Target pasts();
/// What a launcher says to those who watch its run.
Target words();

inline std::vector<Target> all_targets() {
    return {packets(),       scenes(),   meshes(),   texts(),   mitsuba(),       gltf(),          obj(),
            serialized(),    strands(),  pictures(), films(),   manifests(),     jobs(),          checkpoints(),
            graphs(),        keys(),     gates(),    watched(), rays_pbrt(),     rays_mitsuba(),  rays_gltf(),
            rays_obj(),      customs(),  kept(),     pasts(),   words(),         conversations(), lines(),
            rare_pictures(), measured(), profiles(), volumes(), sparse_volumes()};
}

}  // namespace lightnet::fuzz
