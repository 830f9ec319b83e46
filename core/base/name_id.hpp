// Numbers for names, as Cryptomatte has them.
#pragma once

#include <cstdint>
#include <string_view>

namespace lightnet {

/// MurmurHash3_x86_32 (Appleby 2011, public domain) of the bytes of a text.
std::uint32_t murmur3(std::string_view text, std::uint32_t seed = 0);

/// The number by which pictures know a name: its murmur3() taken for the bits of a float32. Where these would be no
/// ordinary number (an exponent of all zeros or ones) the exponent's lowest bit is turned over (Friedman & Jones 2015,
/// "Fully automatic ID mattes with support for motion blur and transparency"; Cryptomatte specification 1.2, "uint32 to
/// float32").
float name_id(std::string_view name);

}  // namespace lightnet
