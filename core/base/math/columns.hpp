// Structures of arrays: many points, coordinate by coordinate, so that loops over points become vector instructions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <new>

#include "core/base/math/vec.hpp"

namespace lightnet {

/// Of so many points at once; all that is known of them stays in the nearest cache.
inline constexpr std::size_t lanes = 32;

using Column = std::array<float, lanes>;
using Flags = std::array<std::uint32_t, lanes>;  // as wide as the numbers

struct Columns2 {
    Column x, y;
    void set(std::size_t i, Vec2 v) {
        x[i] = v.x;
        y[i] = v.y;
    }
    Vec2 operator[](std::size_t i) const { return {x[i], y[i]}; }
};

struct Columns3 {
    Column x, y, z;
    void set(std::size_t i, Vec3 v) {
        x[i] = v.x;
        y[i] = v.y;
        z[i] = v.z;
    }
    Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// Gives a std::vector memory that begins with a line of the cache: no vector of the processor's lies across two.
template <class T>
struct InLines {
    using value_type = T;
    static constexpr std::align_val_t line{64};

    InLines() = default;
    template <class U>
    InLines(const InLines<U>&) {}
    T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), line)); }
    void deallocate(T* memory, std::size_t) { ::operator delete(memory, line); }
    friend bool operator==(InLines, InLines) { return true; }
};

/// Calls many.work(), an always_inline loop over lanes, in vectors as wide as this processor has them. With no fused
/// operations anywhere, its results are the same in any width.
#if defined(__x86_64__)
template <class Many>
[[gnu::target("avx2")]] void work_in_avx2(Many& many) {
    many.work();
}
template <class Many>
void work_side_by_side(Many& many) {
    __builtin_cpu_supports("avx2") ? work_in_avx2(many) : many.work();
}
#else
template <class Many>
void work_side_by_side(Many& many) {
    many.work();
}
#endif

}  // namespace lightnet
