#include "transport/wire/columns.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

#include "transport/wire/body.hpp"

namespace lightnet::packet {
namespace {

static_assert(std::endian::native == std::endian::little, "columns are little-endian, and copied as they are");

using Buffer = std::vector<std::byte>;
using View = std::span<const std::byte>;

/// `size` bytes at `offset` of each question.
struct Column {
    const char* name;
    std::size_t offset, size;
    bool number = false;  // a whole number of 4 bytes: small ones take less
};

template <class Question>
constexpr std::array<Column, 0> columns{};

template <>
constexpr std::array columns<Query>{Column{"stream", offsetof(Query, stream), 8},
                                    Column{"instance", offsetof(Query, instance), 4, true},
                                    Column{"geometry", offsetof(Query, geometry), 4, true},
                                    Column{"primitive", offsetof(Query, primitive), 4, true},
                                    Column{"uv", offsetof(Query, u), 8},
                                    Column{"outgoing", offsetof(Query, outgoing), 12},
                                    Column{"sample", offsetof(Query, sample), 4, true},
                                    Column{"flags", offsetof(Query, lobes), 4, true},
                                    Column{"medium", offsetof(Query, time), 4, true},  // and time
                                    Column{"room", offsetof(Query, room), 4, true}};

template <>
constexpr std::array columns<Tile>{Column{"x", offsetof(Tile, x), 4},
                                   Column{"y", offsetof(Tile, y), 4},
                                   Column{"width", offsetof(Tile, width), 4},
                                   Column{"height", offsetof(Tile, height), 4},
                                   Column{"first", offsetof(Tile, first_sample), 4},
                                   Column{"samples", offsetof(Tile, samples), 4},
                                   Column{"stride", offsetof(Tile, stride), 4},
                                   Column{"coarse", offsetof(Tile, coarse), 4}};

template <>
constexpr std::array columns<Step>{Column{"kind", offsetof(Step, kind), 4}, Column{"call", offsetof(Step, call), 4},
                                   Column{"first", offsetof(Step, first), 4}, Column{"count", offsetof(Step, count), 4},
                                   Column{"data", offsetof(Step, data), 32}};

// Loops whose copies have a constant size.
template <std::size_t Size>
void copy_strided(std::byte* to, std::size_t to_step, const std::byte* from, std::size_t from_step, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) std::memcpy(to + i * to_step, from + i * from_step, Size);
}

void copy_column(std::size_t size, std::byte* to, std::size_t to_step, const std::byte* from, std::size_t from_step,
                 std::size_t count) {
    switch (size) {
        case 4:
            return copy_strided<4>(to, to_step, from, from_step, count);
        case 8:
            return copy_strided<8>(to, to_step, from, from_step, count);
        case 12:
            return copy_strided<12>(to, to_step, from, from_step, count);
        default:
            return copy_strided<32>(to, to_step, from, from_step, count);
    }
}

// The low `Size` bytes of numbers there, and back to numbers of four bytes. Numbers are little-endian.
template <std::size_t Size>
void narrow(std::byte* to, const std::byte* from, std::size_t from_step, std::size_t count) {
    copy_strided<Size>(to, Size, from, from_step, count);
}

template <std::size_t Size>
void widen(std::byte* to, std::size_t to_step, const std::byte* from, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t value = 0;
        std::memcpy(&value, from + i * Size, Size);
        std::memcpy(to + i * to_step, &value, sizeof value);
    }
}

/// What the numbers of a column have in common.
struct Range {
    std::uint32_t first = 0, all_bits = 0, other_bits = 0;
    bool constant() const { return other_bits == 0; }
    std::size_t width() const { return all_bits < 1u << 8 ? 1 : all_bits < 1u << 16 ? 2 : 4; }
};

Range range_of(const std::byte* from, std::size_t step, std::size_t count) {
    Range range;
    std::memcpy(&range.first, from, sizeof range.first);
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t value;
        std::memcpy(&value, from + i * step, sizeof value);
        range.all_bits |= value;
        range.other_bits |= value ^ range.first;
    }
    return range;
}

void pack_numbers(const char* name, const std::byte* from, std::size_t step, std::size_t count, BodyWriter& writer) {
    const Range range = range_of(from, step, count);
    if (range.constant()) return writer.number(name, range.first);
    auto* const to = writer.room(name, count * range.width()).data();
    switch (range.width()) {
        case 1:
            return narrow<1>(to, from, step, count);
        case 2:
            return narrow<2>(to, from, step, count);
        default:
            return narrow<4>(to, from, step, count);
    }
}

// `more`: other entries that will follow.
template <class Question>
BodyWriter pack(const std::vector<Question>& questions, Buffer& body, std::size_t more = 0) {
    const std::size_t count = questions.size();
    body.reserve(count * sizeof(Question) + 256);
    BodyWriter writer(body, columns<Question>.size() + more);
    for (const auto& column : columns<Question>) {
        const auto* from = reinterpret_cast<const std::byte*>(questions.data()) + column.offset;
        if (column.number)
            pack_numbers(column.name, from, sizeof(Question), count, writer);
        else
            copy_column(column.size, writer.room(column.name, count * column.size).data(), column.size, from,
                        sizeof(Question), count);
    }
    return writer;
}

/// A column as it lies in a body: its entries, or the number that they all are.
struct Found {
    View entries;
    std::uint32_t number = 0;
};

std::optional<Found> find(const BodyReader& map, const Column& column, std::size_t count) {
    if (const auto bytes = map.bytes(column.name)) {
        const bool whole = bytes->size() == count * column.size;
        const bool narrowed = column.number && (bytes->size() == count || bytes->size() == count * 2);
        if (whole || narrowed) return Found{*bytes, 0};
    } else if (column.number) {
        const auto number = map.number(column.name);
        if (number && *number <= std::numeric_limits<std::uint32_t>::max())
            return Found{{}, static_cast<std::uint32_t>(*number)};
    }
    return std::nullopt;
}

void write(const Found& found, const Column& column, std::byte* to, std::size_t step, std::size_t count) {
    const auto* const from = found.entries.data();
    if (found.entries.size() == count * column.size)
        copy_column(column.size, to, step, from, column.size, count);
    else if (found.entries.size() == count)
        widen<1>(to, step, from, count);
    else
        widen<2>(to, step, from, count);
}

}  // namespace

void pack_columns(const std::vector<Query>& questions, Buffer& body) { pack(questions, body); }
void pack_columns(const std::vector<Tile>& tiles, Buffer& body) { pack(tiles, body); }
void pack_columns(const std::vector<Step>& steps, const Bytes& data, Buffer& body) {
    auto writer = pack(steps, body, data ? 1 : 0);
    if (data) writer.bytes("result", *data);
}

Bytes unpack_data(View body) {
    const BodyReader map(body);
    const auto data = map.good() ? map.bytes("result") : std::nullopt;
    return data ? std::make_shared<const std::vector<std::byte>>(data->begin(), data->end()) : nullptr;
}

template <class Question>
std::optional<Questions<Question>> unpack_columns(std::size_t count, View body) {
    if (count == 0 || count > most_questions) return std::nullopt;
    const BodyReader map(body);
    if (!map.good()) return std::nullopt;
    // Every column is there and has its size: only then room is made for the questions. Some columns are never a
    // single number, so the room is in proportion to what has come.
    std::array<Found, columns<Question>.size()> found;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const auto one = find(map, columns<Question>[i], count);
        if (!one) return std::nullopt;
        found[i] = *one;
    }
    // DECISIONS: packets-are-flat
    Question alike;  // with the numbers that all have
    for (std::size_t i = 0; i < found.size(); ++i)
        if (found[i].entries.empty())
            std::memcpy(reinterpret_cast<std::byte*>(&alike) + columns<Question>[i].offset, &found[i].number,
                        sizeof found[i].number);
    auto questions = std::make_shared<std::vector<Question>>(count, alike);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const auto& column = columns<Question>[i];
        if (found[i].entries.empty()) continue;
        write(found[i], column, reinterpret_cast<std::byte*>(questions->data()) + column.offset, sizeof(Question),
              count);
    }
    return questions;
}

template std::optional<Questions<Query>> unpack_columns<Query>(std::size_t, View);
template std::optional<Questions<Tile>> unpack_columns<Tile>(std::size_t, View);
template std::optional<Questions<Step>> unpack_columns<Step>(std::size_t, View);

}  // namespace lightnet::packet
