#include "tests/support/oracle_run.hpp"

#include <deque>
#include <utility>

#include "core/base/error.hpp"
#include "transport/wire/packet.hpp"

namespace lightnet {
namespace {

using Done = std::function<void(const Tile&, std::span<const Rgb>)>;

constexpr std::uint32_t from_master = 0xffffffff;  // the channel of the tiles

// Carries from the one place to itself.
class OracleCarrier final : public Carrier {
public:
    OracleCarrier(const std::vector<Tile>& tiles, std::uint32_t image, std::uint32_t width, const Done& done)
        : tiles_(tiles), done_(done) {
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            Message message;
            message.channel = from_master;
            message.bundle = i;
            message.node = image;
            message.width = width;
            message.questions = std::make_shared<const std::vector<Tile>>(1, tiles[i]);
            push(message, true);
        }
    }

    bool ask(const PlaceAt&, Message& message) override {
        push(message, true);
        return true;
    }

    void reply(Message message) override {
        if (message.channel != from_master) return push(message, false);
        if (message.type == Message::Type::failure) throw Error(message.trouble.why);
        done_(tiles_[message.bundle], message.answers);
        ++tiles_done_;
    }

    std::optional<Message> receive() override {
        if (tiles_done_ == tiles_.size() && !std::exchange(stopped_, true)) {
            Message stop;
            stop.type = Message::Type::stop;
            return stop;
        }
        if (packets_.empty()) return std::nullopt;
        const auto packet = std::move(packets_.front());
        packets_.pop_front();
        auto message = packet::unpack(packet.header, packet.body);
        if (!message) throw Error("a packet can't be read back");
        return message;
    }

    void wait(std::chrono::nanoseconds) override {}
    void forget(const PlaceAt&) override {}
    const Counters& counters() const override { return counters_; }

private:
    void push(const Message& message, bool ask) {
        auto packet = packet::pack(message, 0);
        // Replies overtake asks and asks are served from both ends: order must not matter.
        if (ask && ++turn_ % 2)
            packets_.push_back(std::move(packet));
        else
            packets_.push_front(std::move(packet));
    }

    const std::vector<Tile>& tiles_;
    const Done& done_;
    std::deque<packet::Packet> packets_;
    std::size_t tiles_done_ = 0;
    unsigned turn_ = 0;
    bool stopped_ = false;
    Counters counters_;
};

}  // namespace

Counters run_oracle(const std::shared_ptr<const Network>& network, const std::vector<Tile>& tiles, Tuning rules,
                    const Done& done) {
    const auto image = renderer_of(network->graph, network->registry);
    rules.call_own_nodes = false;
    const Plan plan{{PlaceAt{}}, std::vector<std::vector<std::uint32_t>>(network->graph.nodes.size(), {0})};
    OracleCarrier carrier(tiles, static_cast<std::uint32_t>(image),
                          static_cast<std::uint32_t>(network->width_of(image)), done);
    Gauge gauge(network->graph.nodes.size(), asking_edges(network->graph, network->layers, network->registry).size());
    Place place(*network, PlaceAt{}, plan, 0, rules, carrier, gauge);
    const std::atomic<bool> never{false};
    std::atomic<std::uint64_t> progress{0};
    place.serve(never, progress);
    return place.counters();
}

}  // namespace lightnet
