// Frames of a sequence, as files, for whoever makes a film of them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/film/png.hpp"
#include "core/film/tone.hpp"

namespace lightnet {

/// One of them.
struct FrameFile {
    int number = 0;
    std::string file;
};

/// The files of a name with a place for the number, like "shot.####.exr", in the order of their numbers. Throws
/// UserError: the name has no place, or there are none.
std::vector<FrameFile> frame_files(const std::string& pattern);
/// Those of them that are wanted; none: all. Throws UserError, also where none of them is there.
std::vector<FrameFile> frame_files(const std::string& pattern, const std::vector<int>& wanted);

/// Numbers that are missing between the first and the last, in words: "4, 7-9"; "": none.
std::string missing_frames(const std::vector<FrameFile>& frames);

/// How all of them are shown: as the first, so that none flickers. Throws UserError when that can't be read.
PngView view_of_film(const std::vector<FrameFile>& frames, const PngRequest& wanted);

/// Writes each as a PNG, whose name `name` gives with the place of the frame in the film, from 1 on. Throws UserError
/// when one can't be read or has another size than the first, or when they would take the place of the frames' own
/// PNGs; Error when they would take that of somebody else's files.
void write_strip(const std::vector<FrameFile>& frames, const PngView& view, const std::string& name);

/// Writes all small, beside and below each other, as one PNG. Throws UserError.
void write_sheet(const std::vector<FrameFile>& frames, const PngView& view, const std::filesystem::path& png);

/// Throws Error when a film would take the place of a file that is none.
void expect_film_place(const std::filesystem::path& film);

/// Has ffmpeg make a film of the PNGs of such a name. False: it is not installed. Throws Error with what it says.
bool encode_film(const std::string& strip, double fps, const std::string& film);

}  // namespace lightnet
