#include "core/readers/gltf/meshopt.hpp"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <string>

namespace lightnet::gltf {
namespace {

struct Packing {
    std::uint64_t count = 0, stride = 0;
    std::string mode, filter;
};

/// What the library takes for granted. "": all of it holds.
std::string fault_of(const Packing& packing, std::size_t bytes) {
    const bool numbers = packing.mode == "ATTRIBUTES";
    if (!numbers && packing.mode != "TRIANGLES" && packing.mode != "INDICES")
        return "must have the mode ATTRIBUTES, TRIANGLES or INDICES";
    if (numbers && !(packing.stride > 0 && packing.stride <= 256 && packing.stride % 4 == 0))
        return "must have a byteStride of 4, 8 … 256";
    if (!numbers && packing.stride != 2 && packing.stride != 4) return "must have a byteStride of 2 or 4";
    if (packing.mode == "TRIANGLES" && packing.count % 3 != 0) return "must have a count that is a multiple of 3";
    // sound data can't grow more: eight bits tell of 16 bytes at least, and of an index
    if (packing.count > std::uint64_t{bytes} * 256) return "asks for far more than the file holds";
    return "";
}

/// None: no such filter, or not for that stride.
bool filter(const Packing& packing, void* data) {
    const auto count = static_cast<std::size_t>(packing.count), stride = static_cast<std::size_t>(packing.stride);
    if (packing.filter == "NONE") return true;
    if (packing.mode != "ATTRIBUTES") return false;
    if (packing.filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
        meshopt_decodeFilterOct(data, count, stride);
    else if (packing.filter == "QUATERNION" && stride == 8)
        meshopt_decodeFilterQuat(data, count, stride);
    else if (packing.filter == "EXPONENTIAL")
        meshopt_decodeFilterExp(data, count, stride);
    else
        return false;
    return true;
}

bool decode(const Packing& packing, std::span<const std::byte> bytes, void* to) {
    const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
    const auto count = static_cast<std::size_t>(packing.count), stride = static_cast<std::size_t>(packing.stride);
    const auto fault = packing.mode == "ATTRIBUTES" ? meshopt_decodeVertexBuffer(to, count, stride, from, bytes.size())
                       : packing.mode == "TRIANGLES"
                           ? meshopt_decodeIndexBuffer(to, count, stride, from, bytes.size())
                           : meshopt_decodeIndexSequence(to, count, stride, from, bytes.size());
    return fault == 0;
}

}  // namespace

std::optional<std::vector<std::byte>> unpack_view(const At& packed, std::span<const std::byte> bytes) {
    const Packing packing{packed["count"].whole(0), packed["byteStride"].whole(0), packed["mode"].text(""),
                          packed["filter"].text("NONE")};
    if (const std::string fault = fault_of(packing, bytes.size()); !fault.empty()) {
        packed.error(fault);
        return std::nullopt;
    }
    std::vector<std::byte> result(static_cast<std::size_t>(packing.count * packing.stride));
    if (packing.count > 0 && !decode(packing, bytes, result.data())) {
        packed.error("is damaged: its bytes can't be unpacked");
        return std::nullopt;
    }
    if (!filter(packing, result.data())) {
        packed.error(fmt::format("has a filter '{}' that does not suit it", packing.filter.substr(0, 32)));
        return std::nullopt;
    }
    return result;
}

}  // namespace lightnet::gltf
