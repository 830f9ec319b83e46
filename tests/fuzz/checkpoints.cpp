#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/base/error.hpp"
#include "core/base/hash.hpp"
#include "core/film/checkpoint.hpp"
#include "tests/fuzz/targets.hpp"

namespace lightnet::fuzz {
namespace {

const FilmFormat format{8, 4, {"emission", "direct"}, 300};

/// A file of this process.
const std::filesystem::path& file() {
    static const auto path =
        std::filesystem::temp_directory_path() / ("lightnet-fuzz-checkpoint-" + std::to_string(getpid()));
    return path;
}

void attempt(std::string_view bytes) {
    std::ofstream(file(), std::ios::binary) << bytes;
    try {
        if (auto found = read_checkpoint(file())) Film(format).restore(std::move(found->film));
    } catch (const Error&) {
    }
    std::filesystem::remove(file());
}

void read(std::span<const std::byte> bytes) {
    std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    attempt(text);
    Hash hash;
    if (text.size() < sizeof hash.bytes) return;
    // The hash keeps out what the disk has damaged, not what somebody has written.
    text.resize(text.size() - sizeof hash.bytes);
    hash = content_hash(std::string_view(text));
    attempt(text.append(reinterpret_cast<const char*>(hash.bytes.data()), sizeof hash.bytes));
}

std::string text_of(const Film& film) {
    write_checkpoint(file(), {{{"seed", "7"}, {"size", "8x4"}}, film.state()});
    std::ifstream in(file(), std::ios::binary);
    std::string text((std::istreambuf_iterator<char>(in)), {});
    std::filesystem::remove(file());
    return text;
}

std::vector<std::string> seeds() {
    Film some(format), none(format);
    const auto tiles = tiles_of(format.width, format.height, 4, format.samples);
    // Some whole, and one in the middle of which blocks have to wait.
    some.add(tiles.front(), std::vector<Rgb>(tiles.front().pixels() * format.layers.size(), {1, 2, 3}));
    const auto blocks = one_by_one(tiles.back());
    for (const std::size_t block : {0, 2, 3})
        if (block < blocks.size())
            some.add(blocks[block], std::vector<Rgb>(tiles.back().pixels() * format.layers.size(), {1, 2, 3}));
    return {text_of(some), text_of(none)};
}

}  // namespace

Target checkpoints() { return {"checkpoints", read, seeds}; }

}  // namespace lightnet::fuzz
