#include "core/film/checkpoint.hpp"

#include <cerrno>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>

#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"
#include "core/base/hash.hpp"
#include "core/base/json.hpp"
#include "core/base/json_tree.hpp"
#include "core/base/plain_file.hpp"
#include "core/base/printable.hpp"
#include "core/base/words_of.hpp"

namespace lightnet {
namespace {

constexpr std::uint64_t largest_checkpoint = std::uint64_t{64} << 30;

// magic, size of the text, text (JSON), sums, blocks that wait, hash of all before it. Little-endian, as in memory.
constexpr std::string_view magic = "lightnet checkpoint 5\n";

// The hash of all has been checked before it is read.
constexpr JsonLimits as_large_as_the_film{.bytes = std::size_t{1} << 30, .values = 100'000'000, .depth = 8};

template <class T>
std::string_view view_of(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

class Reader {
public:
    explicit Reader(std::string_view bytes) : left_(bytes) {}
    template <class T>
    void get(T* values, std::size_t count) {
        if (count > left_.size() / sizeof(T)) throw Error("it is damaged");
        if (count > 0) std::memcpy(values, left_.data(), count * sizeof(T));
        left_.remove_prefix(count * sizeof(T));
    }
    std::string_view text(std::size_t size) {
        if (size > left_.size()) throw Error("it is damaged");
        const auto text = left_.substr(0, size);
        left_.remove_prefix(size);
        return text;
    }
    std::size_t left() const { return left_.size(); }

private:
    std::string_view left_;
};

std::string text_of(const Checkpoint& checkpoint) {
    const auto& film = checkpoint.film;
    JsonTree parts = JsonTree::list();
    for (const auto& part : film.parts) {
        JsonTree waiting = JsonTree::list();
        for (const auto& [block, sum] : part.waiting) waiting.push_back({block, sum.blocks, sum.pixels.size()});
        parts.push_back({part.x, part.y, part.width, part.height, part.next_block, std::move(waiting), part.ended});
    }
    return sorted_text({{"of", checkpoint.of},
                        {"samples", film.samples},
                        {"sums", film.sums.size()},
                        {"spreads", film.spreads.size()},
                        {"lost", film.lost},
                        {"parts", std::move(parts)}});
}

std::vector<Rgb> colours(Reader& reader, std::size_t count) {
    if (count > reader.left() / sizeof(Rgb)) throw Error("it is damaged");
    std::vector<Rgb> colours(count);
    reader.get(colours.data(), count);
    return colours;
}

std::uint32_t number(const Json& value) { return value.whole<std::uint32_t>(); }

FilmState::Part part_of(const Json& text, Reader& reader) try {
    const auto& values = text.list(7);
    FilmState::Part part{number(values[0]), number(values[1]), number(values[2]),
                         number(values[3]), number(values[4]), {},
                         values[6].flag()};
    for (const auto& waits : values[5].list()) {
        const auto& sum = waits.list(3);
        FilmState::Sum made{number(sum[1]), colours(reader, number(sum[2]))};
        if (!part.waiting.emplace(number(sum[0]), std::move(made)).second) throw Error("it has a block twice");
    }
    return part;
} catch (const JsonError&) {
    throw Error("a part of it is damaged");
}

FilmState film_of(const Json& text, Reader& reader) {
    FilmState film;
    film.samples = number(text.at("samples"));
    film.sums = colours(reader, text.at("sums").whole<std::size_t>());
    const auto spreads = text.at("spreads").whole<std::size_t>();
    if (spreads > reader.left() / sizeof(PixelSpread)) throw Error("it is damaged");
    film.spreads.resize(spreads);
    reader.get(film.spreads.data(), spreads);
    for (const auto& lost : text.at("lost").list()) film.lost.push_back(lost.whole<std::uint64_t>());
    for (const auto& part : text.at("parts").list()) film.parts.push_back(part_of(part, reader));
    if (reader.left() > 0) throw Error("it holds more than it says");
    return film;
}

Checkpoint from_bytes(std::string_view bytes) {
    if (!bytes.starts_with(checkpoint_beginning)) throw Error("it is no checkpoint");
    if (!bytes.starts_with(magic)) throw Error("it is the checkpoint of another version of lightnet");
    Hash hash;
    if (bytes.size() < magic.size() + sizeof hash.bytes) throw Error("it is damaged");
    const auto content = bytes.substr(0, bytes.size() - sizeof hash.bytes);
    std::memcpy(hash.bytes.data(), bytes.data() + content.size(), sizeof hash.bytes);
    if (content_hash(content) != hash) throw Error("it is damaged");
    Reader reader(content.substr(magic.size()));
    std::uint64_t size = 0;
    reader.get(&size, 1);
    try {
        const Json text = parse_json(reader.text(size), as_large_as_the_film);
        std::map<std::string, std::string> of;
        for (const auto& [name, value] : text.at("of").object()) of[name] = value.text();
        return {std::move(of), film_of(text, reader)};
    } catch (const JsonError&) {  // its words are for programmers
        throw Error("it is damaged");
    }
}

// take(pieces), one behind the other, from where they lie: a large film is not copied again.
template <class Take>
void in_pieces(const Checkpoint& checkpoint, const Take& take) {
    const auto& film = checkpoint.film;
    const std::string text = text_of(checkpoint);
    const std::uint64_t size = text.size();
    std::vector<std::string_view> pieces{magic, view_of(std::span(&size, 1)), text, view_of(std::span(film.sums)),
                                         view_of(std::span(film.spreads))};
    for (const auto& part : film.parts)
        for (const auto& [block, sum] : part.waiting) pieces.push_back(view_of(std::span(sum.pixels)));
    Hasher hasher;
    for (const auto piece : pieces) hasher.add(std::as_bytes(std::span(piece)));
    const Hash hash = hasher.finish();
    pieces.push_back(view_of(std::span<const unsigned char>(hash.bytes)));
    take(pieces);
}

}  // namespace

std::filesystem::path checkpoint_beside(const std::filesystem::path& picture) {
    return picture.string() + ".checkpoint";
}

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
    in_pieces(checkpoint, [&](const std::vector<std::string_view>& pieces) { write_file(path, pieces); });
}

Bytes checkpoint_bytes(const Checkpoint& checkpoint) {
    std::vector<std::byte> all;
    in_pieces(checkpoint, [&](const std::vector<std::string_view>& pieces) {
        for (const auto piece : pieces) {
            const auto bytes = std::as_bytes(std::span(piece));
            all.insert(all.end(), bytes.begin(), bytes.end());
        }
    });
    return std::make_shared<const std::vector<std::byte>>(std::move(all));
}

Checkpoint checkpoint_in(std::span<const std::byte> bytes) {
    return from_bytes({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) return std::nullopt;
    const std::string bytes = PlainFile(path, largest_checkpoint).text();
    try {
        return from_bytes(bytes);
    } catch (const std::bad_alloc&) {
        throw Error(path.string(), "there is not enough memory for its film");
    } catch (const std::exception& error) {
        throw Error(path.string(), words_of(error));
    }
}

std::string differences(const std::map<std::string, std::string>& theirs,
                        const std::map<std::string, std::string>& ours) {
    std::string text;
    for (const auto& [name, value] : ours) {
        const auto found = theirs.find(name);
        const auto other = found == theirs.end() ? std::string("unknown") : found->second;
        if (other == value) continue;
        constexpr std::size_t longest = 40;  // hashes say little
        text += (text.empty() ? "" : "; ") + name;
        if (other.size() < longest && value.size() < longest)
            text += " " + printable(other) + " there, " + value + " here";
    }
    return text;
}

}  // namespace lightnet
