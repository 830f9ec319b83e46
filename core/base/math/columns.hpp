// Many points as a structure of arrays, coordinate by coordinate: what compilers turn loops into SIMD vectors from.
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

/// Vectors of which width loops over many points are compiled for.
enum class Width { narrow, avx2, avx512 };
/// The widest that this processor has; or a narrower one that LIGHTNET_VECTORS names (narrow, avx2), to compare them.
Width vector_width();

/// Calls many.work(), an always_inline loop over lanes, in vectors as wide as vector_width(). With no fused operations
/// anywhere, its results are the same in any width.
#if defined(__x86_64__)
template <class Many>
[[gnu::target("avx2")]] void work_in_avx2(Many& many) {
    many.work();
}
template <class Many>
void work_in_lanes(Many& many) {
    vector_width() == Width::narrow ? many.work() : work_in_avx2(many);
}
#else
template <class Many>
void work_in_lanes(Many& many) {
    many.work();
}
#endif

}  // namespace lightnet
