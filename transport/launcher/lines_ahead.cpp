#include "transport/launcher/lines_ahead.hpp"

#include <chrono>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "transport/lines/line_error.hpp"

namespace lightnet {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto opens_after = 100ms;  // what a run begins with comes first
constexpr auto stays = 60s;

/// Those that wait for somebody.
class Spares {
public:
    using To = std::tuple<std::string, std::string, Handshakes>;  // endpoint, its key, and what is noted
    struct Spare {
        std::unique_ptr<HostLine> line;
        Clock::time_point since;
    };

    explicit Spares(std::shared_ptr<HostTransport> hosts) : hosts_(std::move(hosts)) {}

    HostTransport& hosts() const { return *hosts_; }
    void keep(const To& to, Spare spare) { spares_.insert_or_assign(to, std::move(spare)); }
    /// Null: none waits.
    std::unique_ptr<HostLine> take(const To& to) {
        const auto now = Clock::now();
        std::erase_if(spares_, [&](const auto& one) { return now - one.second.since > stays; });
        auto found = spares_.extract(to);
        return found ? std::move(found.mapped().line) : nullptr;
    }

private:
    std::shared_ptr<HostTransport> hosts_;  // outlives the lines
    std::map<To, Spare> spares_;
};

/// A line in use, and the next.
class LineAhead final : public HostLine {
public:
    struct Way {
        std::string endpoint;
        std::optional<LineKeys> keys;
        Handshakes handshakes;
        Spares::To name() const { return {endpoint, keys ? keys->theirs.text() : "", handshakes}; }
    };
    LineAhead(std::shared_ptr<Spares> spares, Way way) : spares_(std::move(spares)), way_(std::move(way)) {
        line_ = spares_->take(way_.name());
        if (!line_) line_ = spares_->hosts().connect(way_.endpoint, way_.keys, way_.handshakes);
    }
    ~LineAhead() override {
        if (next_.line) spares_->keep(way_.name(), std::move(next_));
    }
    LineAhead(const LineAhead&) = delete;
    LineAhead& operator=(const LineAhead&) = delete;

    void hear(std::vector<IpAddress> addresses) override {
        if (next_.line) next_.line->hear(addresses);
        line_->hear(std::move(addresses));
    }
    void tick(Time now) override {
        line_->tick(now);
        if (next_.line && now - next_.since > stays) next_.line.reset();
        if (next_.line) return next_.line->tick(now);
        if (gave_up_ || !line_->can_send() || now - begun_ < opens_after) return;
        try {
            next_ = {spares_->hosts().connect(way_.endpoint, way_.keys, way_.handshakes), now};
        } catch (const LineError&) {  // the system gives no more
            gave_up_ = true;
        }
    }
    bool send(Frames& frames) override { return line_->send(frames); }
    std::optional<Frames> receive() override { return line_->receive(); }
    bool can_send() const override { return line_->can_send(); }
    void watch(Poll& poll) const override { line_->watch(poll); }
    std::optional<Handshake> look_at_handshake() override { return line_->look_at_handshake(); }
    std::string answering_at() const override { return line_->answering_at(); }
    bool is_open_to_places() const override { return line_->is_open_to_places(); }
    std::string trouble() const override { return line_->trouble(); }

private:
    std::shared_ptr<Spares> spares_;
    Way way_;
    std::unique_ptr<HostLine> line_;
    Spares::Spare next_;
    Time begun_ = Clock::now();
    bool gave_up_ = false;
};

class LinesAhead final : public HostTransport {
public:
    explicit LinesAhead(std::shared_ptr<HostTransport> hosts) : spares_(std::make_shared<Spares>(std::move(hosts))) {}
    std::unique_ptr<HostLine> connect(const std::string& endpoint, const std::optional<LineKeys>& keys,
                                      Handshakes handshakes) override {
        return std::make_unique<LineAhead>(spares_, LineAhead::Way{endpoint, keys, handshakes});
    }
    std::unique_ptr<HostPort> listen(const std::string& endpoint, std::optional<DoorKeys> keys) override {
        return spares_->hosts().listen(endpoint, std::move(keys));
    }

private:
    std::shared_ptr<Spares> spares_;
};

}  // namespace

std::shared_ptr<HostTransport> lines_ahead(std::shared_ptr<HostTransport> hosts) {
    return std::make_shared<LinesAhead>(std::move(hosts));
}

}  // namespace lightnet
