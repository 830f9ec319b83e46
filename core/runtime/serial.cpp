#include "core/runtime/serial.hpp"

#include "core/scene/scene.hpp"

namespace lightnet {

SerialRun::SerialRun(const Network& network, std::function<void()> pause)
    : network_(network),
      image_(renderer_of(network.graph, network.registry)),
      rays_before_(Scene::rays_of_this_thread()),
      assembly_(network, [this, pause = std::move(pause)](std::size_t node, std::size_t width) {
          const auto called = assembly_.called(node);
          return ports_.emplace_back(std::make_unique<CallPort>(called, width, counters_.local_questions, pause)).get();
      }) {
    assembly_.renderer(image_);
}

std::vector<Rgb> SerialRun::render(const Tile& tile) {
    std::vector<Rgb> pixels(tile.pixels() * network_.width_of(image_));
    assembly_.renderer(image_).render(tile, pixels);
    ++counters_.tiles;
    return pixels;
}

Counters SerialRun::counters() const {
    Counters counters = counters_;
    counters.rays = Scene::rays_of_this_thread() - rays_before_;
    return counters;
}

}  // namespace lightnet
