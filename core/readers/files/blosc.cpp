#include "core/readers/files/blosc.hpp"

#include <blosc.h>
#include <fmt/format.h>

#include "core/base/error.hpp"

namespace lightnet {

void unpack_blosc(std::span<const std::byte> packed, std::span<std::byte> to) {
    std::size_t size = 0;
    if (blosc_cbuffer_validate(packed.data(), packed.size(), &size) != 0)
        throw Error("what Blosc has packed is broken");
    if (size != to.size()) throw Error(fmt::format("Blosc has packed {} bytes where {} are wanted", size, to.size()));
    if (size > 0 && blosc_decompress_ctx(packed.data(), to.data(), to.size(), 1) != static_cast<int>(size))
        throw Error("what Blosc has packed is broken");
}

}  // namespace lightnet
