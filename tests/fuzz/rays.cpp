// From a scene that was read to rays: every crash that was ever found lay between the two.
#include "core/base/error.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/support/small_network.hpp"

namespace lightnet::fuzz {

void drop(SceneData) {}

void render(SceneData scene) {
    test::SmallNetwork network(std::move(scene), 2, 2);
    network.add("direct", "DirectLighting").add("path", "PathTracing").add("all", "Combine", {"direct", "path"});
    (void)network.picture(1);
}

}  // namespace lightnet::fuzz
