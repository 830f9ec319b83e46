// The body of a packet: a msgpack map from names to numbers and bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace lightnet::packet {

/// Appends a map of `entries` entries to `out`, one after the other.
class BodyWriter {
public:
    BodyWriter(std::vector<std::byte>& out, std::size_t entries);

    void number(std::string_view name, std::uint64_t value);
    void bytes(std::string_view name, std::span<const std::byte> value);
    /// Room for the bytes of an entry, to be filled before the next call.
    std::span<std::byte> room(std::string_view name, std::size_t size);

private:
    std::vector<std::byte>& out_;
};

/// Reads a map that lies in `body`, which must outlive the reader. Nothing is copied; everything is bounded: at most 64
/// entries, no nesting, no claim that goes beyond the end.
class BodyReader {
public:
    explicit BodyReader(std::span<const std::byte> body);
    ~BodyReader();

    /// False: it is no such map.
    bool good() const { return good_; }
    std::optional<std::span<const std::byte>> bytes(std::string_view name) const;
    std::optional<std::uint64_t> number(std::string_view name) const;
    std::vector<std::pair<std::string_view, std::uint64_t>> all_numbers() const;
    std::vector<std::pair<std::string_view, std::span<const std::byte>>> all_bytes() const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
    bool good_ = false;
};

}  // namespace lightnet::packet
