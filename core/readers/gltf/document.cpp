#include "core/readers/gltf/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string_view>
#include <utility>

#include "core/readers/gltf/meshopt.hpp"
#include "core/readers/gltf/unread.hpp"

namespace lightnet::gltf {
namespace {

std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::uint32_t word(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

int base64_value(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

/// None: not base64.
std::optional<std::vector<std::byte>> from_base64(std::string_view text) {
    while (text.ends_with('=')) text.remove_suffix(1);
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    unsigned bits = 0, count = 0;
    for (const char c : text) {
        const int value = base64_value(c);
        if (value < 0) return std::nullopt;
        bits = (bits << 6 | static_cast<unsigned>(value)) & 0xFFFFFF;
        if ((count += 6) >= 8) bytes.push_back(static_cast<std::byte>(bits >> (count -= 8) & 0xFF));
    }
    return bytes;
}

/// "my%20file.png" → "my file.png"
std::string from_uri(std::string_view uri) {
    const auto digit = [](char c) {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    std::string result;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool coded = uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
        result += coded ? static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2])) : uri[i];
        if (coded) i += 2;
    }
    return result;
}

/// The bytes of "data:…;base64,…", or of "data:…,…" (RFC 2397). None: it is neither.
std::optional<std::vector<std::byte>> from_data_uri(std::string_view uri) {
    const auto comma = uri.find(',');
    if (comma == uri.npos) return std::nullopt;
    const auto data = uri.substr(comma + 1);
    if (uri.substr(0, comma).ends_with(";base64"))
        return data.find('%') == data.npos ? from_base64(data) : from_base64(from_uri(data));
    const std::string plain = from_uri(data);
    const auto* bytes = reinterpret_cast<const std::byte*>(plain.data());
    return std::vector<std::byte>(bytes, bytes + plain.size());
}

}  // namespace

Document::Document(Assets& assets, const std::string& path) : assets_(assets), path_(path) {
    const auto bytes = assets.read(path, {path, 0});
    assets.report().check();
    bytes_ = *bytes;
    try {
        json_ = parse_json(text_of(json_chunk()), document_limits);
    } catch (const Error& problem) {
        throw UserError({path, 0}, problem.what());
    }
    if (!json_.is_object()) throw UserError({path, 0}, "a glTF file is one JSON object");
    const std::string version = root()["asset"]["version"].text("");
    if (!version.starts_with("2."))
        throw UserError({path, 0}, version.empty() ? "asset.version is missing: only glTF 2.0 is read"
                                                   : fmt::format("asset.version is '{}': only glTF 2.0 is read",
                                                                 version.substr(0, 16)));
    const std::string least = root()["asset"]["minVersion"].text("2.0");
    if (least != "2.0")
        assets.report().warn(
            {path, 0},
            fmt::format("it asks for glTF {}, and 2.0 is read: what is new in it is missing", least.substr(0, 16)));
    buffers_.resize(root()["buffers"].size());
}

namespace {

/// Null: there is none.
Json* member(Json& of, const std::string& name) {
    if (auto* object = std::get_if<Json::Object>(&of.data)) {
        const auto found = object->find(name);
        return found == object->end() ? nullptr : &found->second;
    }
    auto* list = std::get_if<Json::List>(&of.data);
    std::size_t place = 0;
    const auto [end, wrong] = std::from_chars(name.data(), name.data() + name.size(), place);
    if (!list || wrong != std::errc{} || end != name.data() + name.size() || place >= list->size()) return nullptr;
    return &(*list)[place];
}

void put_numbers(Json& there, bool is_list, const std::vector<double>& numbers) {
    if (std::holds_alternative<bool>(there.data)) {
        there.data = numbers[0] != 0;
    } else if (is_list) {
        there.data = Json::List{};
        for (const double number : numbers) std::get<Json::List>(there.data).push_back(Json{number});
    } else {
        there.data = numbers[0];
    }
}

}  // namespace

bool Document::put(std::span<const std::string> at, const std::vector<double>& numbers) {
    Json* there = &json_;
    for (std::size_t i = 0; there && i + 1 < at.size(); ++i) {
        Json* next = member(*there, at[i]);
        auto* object = std::get_if<Json::Object>(&there->data);
        // of what a file has, parts may be unsaid: all in them is usual
        if (!next && object && i >= 2 && !at[i].empty()) (next = &(*object)[at[i]])->data = Json::Object{};
        there = next;
    }
    if (!there || at.empty() || numbers.empty()) return false;
    Json* last = member(*there, at.back());
    auto* object = std::get_if<Json::Object>(&there->data);
    if (!last && !object) return false;
    const bool is_list =
        numbers.size() > 1 || at.back() == "weights" || (last && std::holds_alternative<Json::List>(last->data));
    put_numbers(last ? *last : (*object)[at.back()], is_list, numbers);
    return true;
}

void Document::warn_of_unread() const {
    (void)root()["extensions"];  // its members are looked at
    gltf::warn_of_unread(json_, seen_, {path_, 0}, assets_.report());
}

/// The JSON of a .glb, whose binary part is kept; else the whole file.
std::span<const std::byte> Document::json_chunk() {
    const std::span<const std::byte> all(*bytes_);
    if (!text_of(all).starts_with("glTF")) return all;
    if (all.size() < 20) throw Error("the .glb ends early");
    if (word(all, 4) != 2) throw Error(fmt::format("version {} of .glb: only 2 is read", word(all, 4)));
    if (word(all, 8) > all.size()) throw Error("the .glb ends early");
    const std::size_t length = word(all, 12);
    if (word(all, 16) != 0x4E4F534A) throw Error("the first part of the .glb is not JSON");
    if (length > all.size() - 20) throw Error("the .glb ends early");
    const std::size_t next = 20 + length;
    if (all.size() - next >= 8 && word(all, next + 4) == 0x004E4942) {
        if (word(all, next) > all.size() - next - 8) throw Error("the .glb ends early");
        binary_ = all.subspan(next + 8, word(all, next));
    }
    return all.subspan(20, length);
}

Document::Resource Document::try_resource(const At& uri) const {
    const std::string text = uri.text("");
    if (text.empty()) return {nullptr, "names nothing"};
    if (!text.starts_with("data:")) {
        const auto file = beside(path_, from_uri(text));
        // What a scene names is sent to all hosts, and scenes come from anywhere.
        if (!assets_.stays_beside(path_, file))
            return {nullptr, fmt::format("names '{}', which is outside of the scene's folder", text.substr(0, 256))};
        auto [bytes, problem] = assets_.try_read(file);
        return {bytes, bytes ? "" : "names a file that can't be read: " + problem};
    }
    auto decoded = from_data_uri(text);
    if (!decoded)
        return {nullptr, text.find(',') == text.npos ? "is no sound data: a comma is missing" : "is no base64 data"};
    return {std::make_shared<const std::vector<std::byte>>(*std::move(decoded)), ""};
}

std::optional<Bytes> Document::resource(const At& uri) const {
    auto [bytes, problem] = try_resource(uri);
    if (bytes) return std::move(bytes);
    uri.error(problem);
    return std::nullopt;
}

Bytes Document::buffer(std::size_t index) {
    if (buffers_[index]) return *buffers_[index];
    buffers_[index] = nullptr;
    const At at = root()["buffers"][index];
    const std::uint64_t length = at["byteLength"].whole(0);
    Bytes bytes;
    if (at["uri"])
        bytes = resource(at["uri"]).value_or(nullptr);
    else if (index == 0 && !binary_.empty())
        bytes = std::make_shared<const std::vector<std::byte>>(binary_.begin(), binary_.end());
    else
        at.error("has no 'uri'");
    if (!bytes) return nullptr;
    loaded_ += bytes->size();
    if (bytes->size() < length) {
        at.error(fmt::format("has {} bytes, but promises {}", bytes->size(), length));
        return nullptr;
    }
    return *(buffers_[index] = bytes);
}

std::optional<std::span<const std::byte>> Document::view(const At& view_index) {
    const At views = root()["bufferViews"];
    const auto index = view_index.index(views.size());
    if (!index) return std::nullopt;
    const At at = views[*index], packed = at["extensions"]["EXT_meshopt_compression"];
    return packed ? unpacked(*index, packed) : part_of_buffer(at);
}

std::optional<std::span<const std::byte>> Document::unpacked(std::size_t view, const At& packed) {
    auto known = unpacked_.find(view);
    if (known == unpacked_.end()) {
        const auto bytes = part_of_buffer(packed);
        auto made = bytes ? unpack_view(packed, *bytes) : std::nullopt;
        if (made) loaded_ += made->size();
        known = unpacked_.emplace(view, std::move(made)).first;
    }
    if (!known->second) return std::nullopt;
    return std::span<const std::byte>(*known->second);
}

/// What "buffer", "byteOffset" and "byteLength" say.
std::optional<std::span<const std::byte>> Document::part_of_buffer(const At& at) {
    const auto which = at["buffer"].index(buffers_.size());
    if (!which) {
        if (!at["buffer"]) at.error("names no buffer");
        return std::nullopt;
    }
    const Bytes bytes = buffer(*which);
    if (!bytes) return std::nullopt;
    const std::uint64_t offset = at["byteOffset"].whole(0), length = at["byteLength"].whole(0);
    if (offset > bytes->size() || length > bytes->size() - offset) {
        at.error("reaches beyond its buffer");
        return std::nullopt;
    }
    return std::span(*bytes).subspan(offset, length);
}

}  // namespace lightnet::gltf
