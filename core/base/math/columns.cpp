#include "core/base/math/columns.hpp"

#include <cstdlib>
#include <string_view>

namespace lightnet {
namespace {

Width widest() {
#if defined(__x86_64__)
    __builtin_cpu_init();
    const char* text = std::getenv("LIGHTNET_VECTORS");
    const std::string_view named = text ? text : "";
    if (named == "narrow" || !__builtin_cpu_supports("avx2")) return Width::narrow;
    const bool all =
        __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq");
    return all && named != "avx2" ? Width::avx512 : Width::avx2;
#else
    return Width::narrow;
#endif
}

}  // namespace

Width vector_width() {
    static const Width width = widest();
    return width;
}

}  // namespace lightnet
