#include "transport/wire/body.hpp"

#include <cstring>
#include <exception>
#include <msgpack.hpp>
#include <new>

namespace lightnet::packet {
namespace {

constexpr std::size_t most_entries = 64;

// What msgpack writes to.
struct Sink {
    std::vector<std::byte>& out;
    void write(const char* data, std::size_t size) {
        const auto* bytes = reinterpret_cast<const std::byte*>(data);
        out.insert(out.end(), bytes, bytes + size);
    }
};

msgpack::packer<Sink> packer_to(Sink& sink) { return msgpack::packer<Sink>(sink); }

void write_name(Sink& sink, std::string_view name) {
    auto packer = packer_to(sink);
    packer.pack_str(static_cast<std::uint32_t>(name.size()));
    packer.pack_str_body(name.data(), static_cast<std::uint32_t>(name.size()));
}

std::string_view name_of(const msgpack::object_kv& entry) {
    if (entry.key.type != msgpack::type::STR) return {};
    return {entry.key.via.str.ptr, entry.key.via.str.size};
}

std::span<const std::byte> bytes_of(const msgpack::object& value) {
    return {reinterpret_cast<const std::byte*>(value.via.bin.ptr), value.via.bin.size};
}

}  // namespace

BodyWriter::BodyWriter(std::vector<std::byte>& out, std::size_t entries) : out_(out) {
    Sink sink{out_};
    packer_to(sink).pack_map(static_cast<std::uint32_t>(entries));
}

void BodyWriter::number(std::string_view name, std::uint64_t value) {
    Sink sink{out_};
    write_name(sink, name);
    packer_to(sink).pack(value);
}

void BodyWriter::bytes(std::string_view name, std::span<const std::byte> value) {
    const auto to = room(name, value.size());
    if (!value.empty()) std::memcpy(to.data(), value.data(), value.size());
}

std::span<std::byte> BodyWriter::room(std::string_view name, std::size_t size) {
    Sink sink{out_};
    write_name(sink, name);
    packer_to(sink).pack_bin(static_cast<std::uint32_t>(size));
    const std::size_t at = out_.size();
    out_.resize(at + size);
    return {out_.data() + at, size};
}

struct BodyReader::Tree {
    msgpack::object_handle handle;
    std::span<const msgpack::object_kv> entries() const {
        const auto& map = handle.get().via.map;
        return {map.ptr, map.size};
    }
};

BodyReader::BodyReader(std::span<const std::byte> body) : tree_(std::make_unique<Tree>()) {
    constexpr auto by_reference = [](msgpack::type::object_type, std::size_t, void*) { return true; };
    const msgpack::unpack_limit limit(most_entries, most_entries, body.size(), body.size(), 0, 2);
    try {
        std::size_t used = 0;
        tree_->handle = msgpack::unpack(reinterpret_cast<const char*>(body.data()), body.size(), used, by_reference,
                                        nullptr, limit);
        good_ = used == body.size() && tree_->handle.get().type == msgpack::type::MAP;
    } catch (const std::bad_alloc&) {
        throw;  // nothing is wrong with the packet, which must not be lost
    } catch (const std::exception&) {
        good_ = false;  // msgpack says what is wrong by its own exceptions; to us the packet is broken
    }
}

BodyReader::~BodyReader() = default;

std::optional<std::span<const std::byte>> BodyReader::bytes(std::string_view name) const {
    for (const auto& entry : tree_->entries())
        if (name_of(entry) == name && entry.val.type == msgpack::type::BIN) return bytes_of(entry.val);
    return std::nullopt;
}

std::optional<std::uint64_t> BodyReader::number(std::string_view name) const {
    for (const auto& entry : tree_->entries())
        if (name_of(entry) == name && entry.val.type == msgpack::type::POSITIVE_INTEGER) return entry.val.via.u64;
    return std::nullopt;
}

std::vector<std::pair<std::string_view, std::uint64_t>> BodyReader::all_numbers() const {
    std::vector<std::pair<std::string_view, std::uint64_t>> all;
    for (const auto& entry : tree_->entries())
        if (entry.val.type == msgpack::type::POSITIVE_INTEGER) all.emplace_back(name_of(entry), entry.val.via.u64);
    return all;
}

std::vector<std::pair<std::string_view, std::span<const std::byte>>> BodyReader::all_bytes() const {
    std::vector<std::pair<std::string_view, std::span<const std::byte>>> all;
    for (const auto& entry : tree_->entries())
        if (entry.val.type == msgpack::type::BIN) all.emplace_back(name_of(entry), bytes_of(entry.val));
    return all;
}

}  // namespace lightnet::packet
