// libFuzzer's way into one target.
#include <cstdint>

#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const auto target = lightnet::fuzz::FUZZ_TARGET();
    target.read({reinterpret_cast<const std::byte*>(data), size});
    return 0;
}
