// The claims of an OpenEXR file's header, checked before a library takes memory for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

namespace lightnet {

/// Throws Error when the header names more bytes than the file has, or more pixels than any compression packs into so
/// many. `read` gives the next bytes, as many as are there; `size`: of the whole file. What is no OpenEXR file, or of a
/// kind that this does not know, is left to the library.
void check_exr_claims(const std::function<std::size_t(std::span<std::byte>)>& read, std::uint64_t size);
void check_exr_claims(std::span<const std::byte> file);

}  // namespace lightnet
