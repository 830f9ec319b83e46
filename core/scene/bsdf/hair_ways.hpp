// The ways of light through hair, told apart by questions.
#pragma once

#include <cstdint>

namespace lightnet {

/// Bits beside those of `lobe` in a question: which ways through a fibre it is not about. Only hair looks at them.
namespace without_way {
inline constexpr std::uint8_t r = 8;     // reflected
inline constexpr std::uint8_t tt = 16;   // through it
inline constexpr std::uint8_t trt = 32;  // reflected inside, once or more often
inline constexpr std::uint8_t any = r | tt | trt;
}  // namespace without_way

}  // namespace lightnet
