#include "core/run/fiber/rounds.hpp"

#include <algorithm>
#include <utility>

namespace lightnet {

struct Rounds::Round {
    const char* node = "";
    const Work* work = nullptr;
    std::size_t next = 0, count = 0;
    std::size_t at_once = 1, helpers = 0;
    Fibers::Fiber* caller = nullptr;
    bool caller_waits = false;
    std::size_t failed = 0;  // the piece that threw
    std::exception_ptr error;

    bool wants_more() const { return next < count && helpers + 1 < at_once; }
};

Rounds::Rounds(Fibers& fibers, std::size_t most, Wake wake) : fibers_(fibers), most_(most), wake_(std::move(wake)) {}
Rounds::~Rounds() = default;

Rounds::Round& Rounds::open(const char* node, std::size_t count, std::size_t at_once, const Work& work) {
    if (idle_.empty()) idle_.push_back(rounds_.emplace_back(std::make_unique<Round>()).get());
    auto& round = *idle_.back();
    idle_.pop_back();
    round = {};
    round.node = node, round.work = &work, round.count = count, round.at_once = at_once;
    round.caller = fibers_.current();
    if (count > 1) open_.push_back(&round);
    return round;
}

void Rounds::close(Round& round) {
    round.next = round.count;
    if (const auto at = std::find(open_.begin(), open_.end(), &round); at != open_.end()) open_.erase(at);
}

// Takes piece after piece until none is left. Only Cancelled comes out.
void Rounds::work_on(Round& round) {
    while (round.next < round.count) {
        const std::size_t piece = round.next++;
        if (round.next == round.count) close(round);
        try {
            (*round.work)(piece);
        } catch (const Cancelled&) {
            close(round);
            throw;
        } catch (...) {
            if (!round.error || piece < round.failed) round.error = std::current_exception(), round.failed = piece;
            close(round);
        }
    }
}

void Rounds::each(const char* node, std::size_t count, std::size_t at_once, const Work& work) {
    if (!fibers_.current()) {  // nobody else could run meanwhile
        for (std::size_t piece = 0; piece < count; ++piece) work(piece);
        return;
    }
    auto& round = open(node, count, at_once, work);
    const char* const before = fibers_.rename(node);
    std::exception_ptr error;
    try {
        work_on(round);
    } catch (const Cancelled&) {
        error = std::current_exception();
    }
    // However this ends: nobody may be left who still works with what lies on this stack.
    round.caller_waits = true;
    while (round.helpers > 0) fibers_.park_for_others();
    fibers_.rename(before);
    if (!error) error = std::exchange(round.error, nullptr);
    idle_.push_back(&round);
    if (error) std::rethrow_exception(error);
}

bool Rounds::start_one() {
    if (open_.empty() || started_ >= most_ || !fibers_.roomy()) return false;
    const auto wanting = std::find_if(open_.rbegin(), open_.rend(), [](const Round* r) { return r->wants_more(); });
    if (wanting == open_.rend()) return false;
    auto& round = **wanting;
    ++round.helpers;
    ++started_;
    fibers_.start(round.node, [this, &round] { help(round); });
    return true;
}

void Rounds::help(Round& round) {
    struct Leaving {
        Rounds& rounds;
        Round& round;
        ~Leaving() {
            auto& fibers = rounds.fibers_;
            fibers.give_time_to(round.caller);
            --rounds.started_;
            if (--round.helpers > 0 || !round.caller_waits) return;
            fibers.release(round.caller);
            rounds.wake_(round.caller);
        }
    };
    const Leaving leaving{*this, round};
    fibers_.do_as(round.caller);
    work_on(round);
}

}  // namespace lightnet
