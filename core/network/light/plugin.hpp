// A plugin's word of itself: a shared library that brings kinds of nodes or formats of scenes.
#pragma once

#include <cstdint>
#include <vector>

#include "core/network/graph/kind.hpp"
#include "core/network/interface_hash.hpp"

namespace lightnet {

struct SceneFormat;  // core/readers/common/scene_format.hpp

/// How something was compiled, as far as objects that go to and fro depend on it. Filled in where it is compiled.
struct PluginBuild {
    const char* interface_hash = lightnet::interface_hash;  // of all headers that a node sees
    std::uint32_t compiler_abi = __GXX_ABI_VERSION;
    std::uint32_t string_abi = _GLIBCXX_USE_CXX11_ABI;
#ifdef __FAST_MATH__
    std::uint32_t fast_math = 1;  // whose bits nobody knows
#else
    std::uint32_t fast_math = 0;
#endif
};

/// A plugin is a shared library with a function
///
///     extern "C" const lightnet::PluginCard* lightnet_plugin();
///
/// whose answer lives as long as the library. It is loaded before any thread is started, and never unloaded. `layout`
/// and `build` are looked at first; where they are not the program's own, nothing else is touched.
struct PluginCard {
    std::uint32_t layout = 2;  // of this struct
    PluginBuild build = {};
    const char* name = "";  // one word
    const char* version = "";
    /// Either may be null, not both.
    void (*add_kinds)(std::vector<Kind>& kinds) = nullptr;
    void (*add_formats)(std::vector<SceneFormat>& formats) = nullptr;
};

}  // namespace lightnet
