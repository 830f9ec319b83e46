// A glTF file with its buffers: .gltf or .glb.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/readers/common/assets.hpp"
#include "core/readers/gltf/json.hpp"

namespace lightnet::gltf {

/// A list of numbers of equal width, decoded.
struct Values {
    std::size_t width = 0;  // 3 of a VEC3
    std::vector<float> numbers;
    std::size_t count() const { return width ? numbers.size() / width : 0; }
};

/// Of one read. All that it hands out was checked against the bytes that are really there.
class Document {
public:
    /// Throws UserError when the file is no glTF at all; smaller things are reported.
    Document(Assets& assets, const std::string& path);
    Document(const Document&) = delete;
    Document& operator=(const Document&) = delete;

    At root() const { return {json_, path_, assets_.report(), &seen_}; }
    /// Puts numbers where names and places of members lead, from the root on; the last ones may be new. One number
    /// takes the place of one, or of true and false. False: the way leads nowhere. Before anybody reads what is there.
    bool put(std::span<const std::string> at, const std::vector<double>& numbers);
    /// Of what nobody has asked for; when all is read.
    void warn_of_unread() const;
    const std::string& path() const { return path_; }

    /// The values of an accessor; integers that are normalised lie in 0 … 1 or -1 … 1. None: reported.
    std::optional<Values> values(const At& accessor_index);
    /// The values of an accessor of whole numbers without a sign. None: reported.
    std::optional<std::vector<std::uint32_t>> indices(const At& accessor_index);
    /// Makes of whole numbers what an accessor says that they mean: shares, where it is normalised.
    void normalise(const At& accessor_index, Values& values) const;
    /// The bytes of a buffer view, unpacked. None: reported.
    std::optional<std::span<const std::byte>> view(const At& view_index);
    /// The bytes behind a "uri": data in it, or a file. None: reported.
    std::optional<Bytes> resource(const At& uri) const;
    /// Bytes behind a "uri", or null and what is wrong with it.
    struct Resource {
        Bytes bytes;
        std::string problem;
    };
    Resource try_resource(const At& uri) const;

private:
    struct Layout;
    std::optional<Layout> layout(const At& accessor);
    template <class Value>
    std::optional<std::vector<Value>> decoded(const At& accessor_index, std::size_t& width);
    template <class Value>
    bool overlay(const At& sparse, const Layout& layout, std::vector<Value>& values);
    bool spend(const At& where, std::uint64_t elements);
    Bytes buffer(std::size_t index);
    std::optional<std::span<const std::byte>> part_of_buffer(const At& part);
    std::optional<std::span<const std::byte>> unpacked(std::size_t view, const At& packed);
    std::span<const std::byte> json_chunk();

    Assets& assets_;
    std::string path_;
    Bytes bytes_;
    std::span<const std::byte> binary_;  // of a .glb
    Json json_;
    mutable Seen seen_;
    std::vector<std::optional<Bytes>> buffers_;                              // none: not loaded yet; null: reported
    std::map<std::size_t, std::optional<std::vector<std::byte>>> unpacked_;  // views; none: reported
    std::uint64_t spent_ = 0, loaded_ = 0;                                   // elements, bytes
};

}  // namespace lightnet::gltf
