// The serial mode beside what one would write by hand: the same nodes, tied together by plain calls.
#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "core/run/assembly/assembly.hpp"
#include "core/run/serial/serial.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/overhead.hpp"

namespace lightnet::bench {
namespace {

// Calls a node, and nothing else: nothing is cut into pieces, counted, checked or looked after.
class PlainCall final : public Port {
public:
    explicit PlainCall(const LightOp& node) : node_(node) {}
    Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) override {
        std::fill(answers.begin(), answers.end(), Rgb{});
        node_.light(questions, answers);
        return 0;
    }
    void finish(Ticket) override {}
    void abandon(Ticket) noexcept override {}

private:
    const LightOp& node_;
};

class HandWritten {
public:
    explicit HandWritten(const Picture& picture)
        : width_(picture.width()),
          assembly_(*picture.network,
                    [this](std::size_t node, std::size_t) {
                        return ports_.emplace_back(std::make_unique<PlainCall>(assembly_.light(node))).get();
                    },
                    {.locks = &locks_}),
          renderer_(assembly_.renderer(picture.image)) {}

    std::vector<Rgb> render(const Tile& tile) const {
        std::vector<Rgb> pixels(tile.pixels() * width_);
        renderer_.render(tile, pixels);
        return pixels;
    }

private:
    std::size_t width_;
    std::vector<std::unique_ptr<PlainCall>> ports_;
    NoLocks locks_;
    Assembly assembly_;
    const Renderer& renderer_;
};

bool same_bits(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Rgb)) == 0;
}

// How much longer the framework took over all tiles. The two take turns at every tile, and who begins changes.
double extra_time(const Picture& picture, bool swap) {
    SerialRun framework(*picture.network, [] {});
    const HandWritten by_hand(picture);
    double with = 0, without = 0;
    std::vector<Rgb> ours, theirs;
    const auto time = [](double& sum, const auto& render) {
        const double begun = thread_seconds();
        render();
        sum += thread_seconds() - begun;
    };
    for (const auto& tile : picture.tiles) {
        if (swap) time(without, [&] { theirs = by_hand.render(tile); });
        time(with, [&] { ours = framework.render(tile); });
        if (!swap) time(without, [&] { theirs = by_hand.render(tile); });
        if (!same_bits(ours, theirs)) throw std::runtime_error("the hand-written loop gives other pixels");
        swap = !swap;
    }
    return with / without - 1;
}

}  // namespace

void measure_serial(const Picture& picture) {
    std::vector<double> extra;
    for (int round = 0; round < repeated(9); ++round) extra.push_back(extra_time(picture, round % 2 == 0));
    figure("overhead.serial", extra, 0.03, false);
}

}  // namespace lightnet::bench
