// libFuzzer's way into the target that FUZZ_TARGET names in the environment. One program for all of them: each would
// hold the whole of the library.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "tests/fuzz/numbers.hpp"
#include "tests/fuzz/targets.hpp"

namespace {

lightnet::fuzz::Target target_asked_for() {
    const char* const name = std::getenv("FUZZ_TARGET");
    const auto targets = lightnet::fuzz::all_targets();
    const auto found = std::find_if(targets.begin(), targets.end(),
                                    [&](const auto& target) { return name != nullptr && target.name == name; });
    if (found != targets.end()) return *found;
    std::fprintf(stderr, "FUZZ_TARGET is '%s', which is none of:", name != nullptr ? name : "");
    for (const auto& target : targets) std::fprintf(stderr, " %s", target.name.c_str());
    std::fputc('\n', stderr);
    std::exit(2);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const auto target = target_asked_for();
    target.read({reinterpret_cast<const std::byte*>(data), size});
    return 0;
}

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

// One time of three a number is made extreme; else libFuzzer does as usual.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned int seed) {
    if (seed % 3 != 0 || size == 0) return LLVMFuzzerMutate(data, size, most);
    std::string text(reinterpret_cast<const char*>(data), size);
    lightnet::fuzz::make_extreme(text, seed / 3 % size, seed / 7919);
    if (text.size() > most) text.resize(most);
    std::memcpy(data, text.data(), text.size());
    return text.size();
}
