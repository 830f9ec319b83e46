// The port to a node at other places: gathers questions into bundles.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/network/light/port.hpp"
#include "core/run/assembly/gauge.hpp"
#include "core/run/fiber/fiber.hpp"
#include "core/run/message/channel.hpp"
#include "core/run/place/company_wait.hpp"
#include "core/run/schedule/multiplexer.hpp"

namespace lightnet {

/// When a bundle goes.
struct BundleRules {
    std::size_t questions;             // it is full
    std::chrono::microseconds oldest;  // a question has waited so long, and half of what an answer takes, by own time
    std::size_t eager;                 // else only when the place has nothing else to do and fewer are out
    friend bool operator==(const BundleRules&, const BundleRules&) = default;
};

/// Questions of all askers of this place to one node leave together. An asking fiber parks until all of its answers
/// are there. Lives on the place's thread. What asks and bundles are kept in is kept for the next ones, so that a
/// question that is asked alone costs no memory of its own.
class BundlePort final : public Port, public BundleOwner<Query> {
public:
    using Clock = std::chrono::steady_clock;
    using Wake = std::function<void(Fibers::Fiber*)>;

    /// `own` tells the time that the place has had. What goes through it is counted in `count`, and at the edge that
    /// the gauge says is asked along, if these are given; they must outlive it.
    BundlePort(Fibers& fibers, Wake wake, std::size_t width, BundleRules rules, CompanyWait::OwnClock own,
               Gauge::Node* count = nullptr, const Gauge* gauge = nullptr)
        : fibers_(fibers),
          wake_(std::move(wake)),
          width_(width),
          rules_(rules),
          count_(count),
          gauge_(gauge),
          company_(rules.oldest, std::move(own)) {}

    /// Where the bundles go.
    Multiplexer<Query>& replicas() { return replicas_; }
    /// Questions in no bundle yet.
    std::size_t waiting() const { return waiting_; }
    /// From now on bundles go by share() only, and not when they are due.
    void keep_back(bool kept_back) { kept_back_ = kept_back; }
    /// Sends a bundle of at most so many questions.
    void share(std::size_t most);
    /// A bundle of at most so many questions, for this place to answer itself: by answered_here(), or failed().
    Bundle<Query> take_back(std::size_t most);
    void answered_here(const Bundle<Query>& bundle, std::span<const Rgb> answers);

    Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) override;
    void finish(Ticket ticket) override;
    void abandon(Ticket ticket) noexcept override;

    /// Sends the bundles that are due; `idle`: the place has nothing else to do. True if anything was sent.
    bool flush(Clock::time_point now, bool idle);
    /// How long until something is due for its age alone.
    std::chrono::nanoseconds until_due(Clock::time_point now) const;

    void answered(const Bundle<Query>& bundle, std::vector<Rgb> answers) override;
    void failed(const Bundle<Query>& bundle, const Failure& failure) override;
    void returned(Bundle<Query> bundle) override { again_.push_back(std::move(bundle)); }

private:
    // Kept in slots that are used again; the ticket says which slot, and how often it had been used before.
    struct Ask {
        std::uint32_t uses = 0;
        bool open = false;
        std::span<const Query> questions;
        std::span<Rgb> answers;
        std::size_t bundled = 0;  // questions that are in bundles already
        std::size_t unanswered = 0;
        Fibers::Fiber* waiting = nullptr;
        std::optional<Failure> failure;
        Gauge::Edge* edge = nullptr;
    };
    // A run of questions of one ask inside a bundle.
    struct Slice {
        Ticket ask;
        std::size_t first, count;
    };
    // Those of one bundle; kept in slots as well.
    struct Slices {
        std::uint32_t uses = 0;
        bool open = false;
        Clock::time_point sent;
        std::vector<Slice> all;
    };
    using Buffer = std::shared_ptr<std::vector<Query>>;

    Ask* find(Ticket ticket);
    void close(Ticket ticket);
    std::size_t full() const;
    bool due(Clock::time_point now, bool idle);
    void foresee(bool idle);
    Bundle<Query> make_bundle(Clock::time_point now, std::size_t most, bool away);
    bool send_first();
    void count_at(Gauge::Edge& edge, std::size_t questions);
    void hand_out(Slices& slices, const Bundle<Query>& bundle, std::span<const Rgb> answers);
    Buffer empty_buffer();
    std::uint64_t open_slices();
    Slices* slices_of(const Bundle<Query>& bundle);
    void settle(Ask& ask);
    void close(Slices& slices, const Bundle<Query>& bundle);

    Fibers& fibers_;
    Wake wake_;
    std::size_t width_;
    BundleRules rules_;
    Gauge::Node* count_;
    const Gauge* gauge_;
    std::vector<Gauge::Edge*> bundled_;  // edges with questions in the bundle that is being made
    Multiplexer<Query> replicas_;
    std::deque<Ask> asks_;               // stay where they are
    std::vector<std::uint32_t> closed_;  // slots
    std::vector<Ticket> unbundled_;      // asks with questions in no bundle yet, from first_ on
    std::size_t first_ = 0;
    std::size_t waiting_ = 0;  // questions in no bundle yet
    bool kept_back_ = false;
    std::size_t foreseen_ = 0;           // as the replicas were told last
    CompanyWait company_;                // of the first of them, at most
    std::deque<Slices> slices_;          // by slot in the number of the bundle
    std::vector<std::uint32_t> unused_;  // slots of slices_
    std::vector<Buffer> buffers_;        // that no bundle has now
    std::deque<Bundle<Query>> again_;    // came back unanswered
};

}  // namespace lightnet
