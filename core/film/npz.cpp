// Pictures become zip archives of .npy files (PKWARE's APPNOTE 6.3.10; NumPy's format 1.0).
#include "core/film/npz.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <deque>
#include <span>
#include <vector>

#include "core/base/atomic_file.hpp"
#include "core/base/json_tree.hpp"

namespace lightnet {
namespace {

static_assert(std::endian::native == std::endian::little && sizeof(Rgb) == 3 * sizeof(float) &&
              sizeof(Covered) == 2 * sizeof(float));

// So that it can be mapped, and its numbers taken as they lie.
// DECISIONS: python-starts-the-program
constexpr std::size_t aligned_to = 64;

template <class Number>
void append(std::string& bytes, Number number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::size_t gap_before(std::uint64_t at) { return (aligned_to - at % aligned_to) % aligned_to; }

// "(48, 64, 3)"
std::string text_of(const std::vector<std::size_t>& shape) {
    std::string text;
    for (const std::size_t side : shape) text += fmt::format("{}, ", side);
    return "(" + text + ")";
}

std::string npy_header(const std::vector<std::size_t>& shape) {
    constexpr std::size_t before = 10;  // magic, version and length
    std::string words = "{'descr': '<f4', 'fortran_order': False, 'shape': " + text_of(shape) + "}";
    words.append(gap_before(before + words.size() + 1), ' ');
    words += '\n';
    std::string header("\x93NUMPY\x01\x00", 8);
    append(header, static_cast<std::uint16_t>(words.size()));
    return header + words;
}

/// An archive in pieces, of which the larger ones lie elsewhere. Members are stored as they are; all sizes have 64
/// bits.
class Archive {
public:
    void add_text(const std::string& name, std::string text) { add(name, keep(std::move(text)), {}); }
    void add(const std::string& name, const std::vector<std::size_t>& shape, std::span<const float> numbers) {
        add(name + ".npy", keep(npy_header(shape)),
            {reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()});
    }
    std::vector<std::string_view> finish() {
        const std::uint64_t begin = size_, length = directory_.size();
        piece(keep(std::move(directory_)));
        std::string end("PK\x06\x06", 4);
        append(end, std::uint64_t{44});
        append(end, version), append(end, version);
        append(end, std::uint64_t{0});  // disks
        append(end, members_), append(end, members_), append(end, length), append(end, begin);
        end.append("PK\x06\x07", 4);
        append(end, std::uint32_t{0}), append(end, begin + length), append(end, std::uint32_t{1});
        end.append("PK\x05\x06", 4);
        append(end, std::uint32_t{0});
        for (int i = 0; i < 2; ++i) append(end, std::uint16_t{0xffff});
        for (int i = 0; i < 2; ++i) append(end, std::uint32_t{0xffffffff});
        append(end, std::uint16_t{0});
        piece(keep(std::move(end)));
        return std::move(pieces_);
    }

private:
    static constexpr std::uint16_t version = 45, wide = 1, padding = 0xd935;  // ids of extra fields; Android's for gaps

    std::string_view keep(std::string text) { return kept_.emplace_back(std::move(text)); }
    void piece(std::string_view bytes) {
        pieces_.push_back(bytes);
        size_ += bytes.size();
    }
    void add(const std::string& name, std::string_view head, std::string_view body) {
        uLong sum = 0;
        for (const auto part : {head, body})
            if (!part.empty()) sum = crc32_z(sum, reinterpret_cast<const Bytef*>(part.data()), part.size());
        const auto crc = static_cast<std::uint32_t>(sum);
        const std::uint64_t size = head.size() + body.size(), offset = size_;
        std::string extra;
        append(extra, wide), append(extra, std::uint16_t{16}), append(extra, size), append(extra, size);
        constexpr std::size_t fixed = 30, field = 4;
        const auto gap = gap_before(size_ + fixed + name.size() + extra.size() + field);
        append(extra, padding), append(extra, static_cast<std::uint16_t>(gap)), extra.append(gap, '\0');
        std::string local("PK\x03\x04", 4);
        append_facts(local, crc, name, extra.size());
        piece(keep(local + name + extra));
        piece(head), piece(body);
        note(name, crc, size, offset);
    }
    static void append_facts(std::string& bytes, std::uint32_t crc, const std::string& name, std::size_t extra) {
        append(bytes, version);
        append(bytes, std::uint16_t{1 << 11});       // names are UTF-8
        append(bytes, std::uint32_t{0});             // stored; no time
        append(bytes, std::uint16_t{(1 << 5) | 1});  // 1980-01-01
        append(bytes, crc);
        for (int i = 0; i < 2; ++i) append(bytes, std::uint32_t{0xffffffff});
        append(bytes, static_cast<std::uint16_t>(name.size()));
        append(bytes, static_cast<std::uint16_t>(extra));
    }
    void note(const std::string& name, std::uint32_t crc, std::uint64_t size, std::uint64_t offset) {
        directory_.append("PK\x01\x02", 4);
        append(directory_, version);
        append_facts(directory_, crc, name, 28);
        append(directory_, std::uint16_t{0});                                        // no comment
        append(directory_, std::uint32_t{0}), append(directory_, std::uint32_t{0});  // disk, attributes
        append(directory_, std::uint32_t{0xffffffff});
        directory_ += name;
        append(directory_, wide), append(directory_, std::uint16_t{24});
        append(directory_, size), append(directory_, size), append(directory_, offset);
        ++members_;
    }

    std::deque<std::string> kept_;  // whose texts stay where they are
    std::vector<std::string_view> pieces_;
    std::string directory_;
    std::uint64_t size_ = 0, members_ = 0;
};

std::span<const float> numbers_of(const std::vector<Rgb>& pixels) { return {&pixels.data()->r, 3 * pixels.size()}; }

JsonTree facts_of(const Picture& picture) {
    JsonTree layers = JsonTree::list(), shown = JsonTree::list(), mattes = JsonTree::list(),
             matrices = JsonTree::object();
    for (const auto& layer : picture.layers)
        layers.push_back({{"name", layer.name}, {"gain", JsonTree({layer.gain.r, layer.gain.g, layer.gain.b})}});
    for (const auto& layer : picture.shown) shown.push_back({{"name", layer.name}, {"letters", layer.letters}});
    for (const auto& matte : picture.mattes) mattes.push_back({{"name", matte.name}, {"manifest", matte.manifest}});
    for (const auto& [name, entries] : picture.notes.matrices)
        matrices[name] = std::vector<float>(entries.begin(), entries.end());
    return {{"width", picture.width},
            {"height", picture.height},
            {"x", picture.x},
            {"y", picture.y},
            {"whole_width", picture.whole_width ? picture.whole_width : picture.width},
            {"whole_height", picture.whole_height ? picture.whole_height : picture.height},
            {"done", picture.done},
            {"compression", picture.storage.compression},
            {"layers", std::move(layers)},
            {"shown", std::move(shown)},
            {"mattes", std::move(mattes)},
            {"notes", picture.notes.texts},
            {"matrices", std::move(matrices)}};
}

}  // namespace

void write_npz(const std::filesystem::path& path, const Picture& picture) {
    const std::size_t height = picture.height, width = picture.width;
    const auto colours = [&](const std::string& name, const std::vector<Rgb>& pixels, Archive& archive) {
        archive.add(name, {height, width, 3}, numbers_of(pixels));
    };
    Archive archive;
    archive.add_text("picture.json", to_text(facts_of(picture)));
    colours("beauty", picture.beauty, archive);
    for (const auto& layer : picture.layers) colours("layers/" + layer.name, layer.pixels, archive);
    for (const auto& layer : picture.shown) colours("shown/" + layer.name, layer.pixels, archive);
    if (!picture.alpha.empty()) archive.add("alpha", {height, width}, picture.alpha);
    if (!picture.samples.empty()) archive.add("samples", {height, width}, picture.samples);
    for (const auto& matte : picture.mattes)
        archive.add("mattes/" + matte.name, {height, width, matte.ranks, 2},
                    {&matte.pixels.data()->id, 2 * matte.pixels.size()});
    write_file(path, archive.finish());
}

}  // namespace lightnet
