// Stands for bare_embree.cpp, which takes the place of functions that newer versions of Embree don't have.
#include "tests/bench/bare_embree.hpp"

namespace lightnet::bench {

std::optional<BesideEmbree> beside_bare_embree(const Registry&, const std::string&,
                                               const std::map<std::string, std::string>&, std::size_t) {
    return std::nullopt;
}

}  // namespace lightnet::bench
