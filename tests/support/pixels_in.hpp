// What a picture shows, without what its header says of the graph that made it.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "core/film/exr.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::test {

/// Of the bytes of an EXR: for graphs that are written differently and should give the same picture, or another one.
inline Picture pixels_in(const std::string& exr) {
    const Folder folder;
    std::ofstream(folder / "picture.exr", std::ios::binary) << exr;
    Picture picture = read_exr(folder / "picture.exr");
    picture.notes = {};
    return picture;
}

}  // namespace lightnet::test
