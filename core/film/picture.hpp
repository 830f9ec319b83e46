// A finished picture: what goes into files.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/math/rgb.hpp"

namespace lightnet {

/// What the channels of files are called: those of colours, of vectors, of depths, of texture coordinates
/// and of motion in the picture.
inline constexpr const char* usual_letters = "RGB";
inline constexpr const char* letters_of_vectors = "XYZ";
inline constexpr const char* letters_of_depths = "Z";
inline constexpr const char* letters_of_uv = "UV";
inline constexpr const char* letters_of_motion = "XY";

/// One contribution to the picture.
struct PictureLayer {
    std::string name;
    std::vector<Rgb> pixels;              // row by row, row 0 on top
    Rgb gain{1, 1, 1};                    // so many times it is in the beauty
    std::string letters = usual_letters;  // of its channels in files, one for each number of a pixel that counts
    friend bool operator==(const PictureLayer&, const PictureLayer&) = default;
};

/// How a file keeps a picture.
struct PictureStorage {
    std::string compression = "zip";  // one of lossless_compressions()
    bool half = false;                // what is shown beside the sum has half floats (11 bits)
    bool parts = false;               // each layer has a part of its own; else all channels are in one
    friend bool operator==(const PictureStorage&, const PictureStorage&) = default;
};

/// A layer beside the sum has half floats in such a file; depths, which compositing compares, never have.
inline bool may_be_half(const PictureStorage& storage, const PictureLayer& layer) {
    return storage.half && layer.letters != letters_of_depths;
}

/// Ways in which OpenEXR compresses files without a loss.
const std::vector<std::string>& lossless_compressions();

/// A name that is seen in a pixel, and how much of the pixel it covers.
struct Covered {
    float id = 0, part = 0;  // name_id(); 0 … 1
    friend bool operator==(const Covered&, const Covered&) = default;
};

/// Which names are seen in each pixel: a layer of Cryptomatte.
struct PictureMatte {
    std::string name;
    std::uint32_t ranks = 0;      // names per pixel, an even number
    std::vector<Covered> pixels;  // pixel × rank: what covers most of a pixel first; of equal ones, the smaller bits
    std::string manifest;         // JSON: of each name the bits of its id, 8 hexadecimal digits
    friend bool operator==(const PictureMatte&, const PictureMatte&) = default;
};

/// What is said of a picture, and no pixel depends on: attributes of its file, by their names there.
struct PictureNotes {
    std::map<std::string, std::string> texts;
    std::map<std::string, std::array<float, 16>> matrices;  // as OpenEXR has them: for rows of coordinates
    friend bool operator==(const PictureNotes&, const PictureNotes&) = default;
};

/// A picture and what it is the sum of. Linear RGB with the primaries of BT.709. May be cut out of a larger one.
struct Picture {
    std::uint32_t width = 0, height = 0;              // of what is there
    std::vector<Rgb> beauty;                          // row by row, row 0 on top
    std::vector<PictureLayer> layers;                 // in the order in which they add up to the beauty; may be empty
    std::uint32_t x = 0, y = 0;                       // of its upper left pixel, in the whole picture
    std::uint32_t whole_width = 0, whole_height = 0;  // 0: this is the whole picture
    std::vector<float> samples{};                     // per pixel; empty: the same number everywhere
    std::vector<PictureLayer> shown{};                // beside the sum: what operators answer that others ask
    std::vector<PictureMatte> mattes{};               // ids of what is seen
    std::vector<float> alpha{};                       // the part of each pixel that surfaces cover; empty: not known
    PictureNotes notes{};
    PictureStorage storage{};
    float done = 1;                // how much of the work is in it; below 1: a preview
    std::uint64_t overflowed = 0;  // pixels that are black as their sum is more than a float32 holds
    friend bool operator==(const Picture&, const Picture&) = default;
};

/// Makes pixels black, in all layers, whose layers or the plain sum of them are not finite: many bright samples may add
/// up to more than a float32 holds. Of what is shown beside the sum each layer stands for itself. Counts them, and
/// makes the beauty.
void blacken_overflow(Picture& picture);

/// To the nearest numbers that a half float holds; what is larger becomes the largest.
void round_to_half(std::vector<Rgb>& pixels);

/// The float32 sum of the layers, each times its gain, from the left to the right.
std::vector<Rgb> sum_of(const std::vector<PictureLayer>& layers);

/// The beauty: sum_of() the layers; a pixel whose gains take it beyond a float32 is black in it, and counted.
void make_beauty(Picture& picture);

}  // namespace lightnet
