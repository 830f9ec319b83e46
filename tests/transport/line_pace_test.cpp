// How much is under way on lines of many kinds.
#include "transport/wire/line_pace.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <vector>

namespace lightnet::line_pace_test {
namespace {

using std::chrono::duration;
using std::chrono::milliseconds;
using std::chrono::seconds;
using Time = LinePace::Time;

/// Ends that have always more to send, over one line: what they send waits in its queue, is carried at its rate, and
/// the answers to marks come back after the way there and back.
class SharedLine {
public:
    SharedLine(std::size_t ends, double rate, milliseconds way) : ends_(ends), rate_(rate), way_(way) {}

    void pass(seconds time) {
        constexpr auto step = milliseconds(1);
        for (const auto end = now_ + time; now_ < end; now_ += step) {
            for (std::size_t i = 0; i < ends_.size(); ++i) say_back(i), send(i);
            longest_queue_ = std::max(longest_queue_, queue());
        }
    }
    /// How long what is said now would wait.
    duration<double> queue() const { return std::max(duration<double>(0), duration<double>(free_ - now_)); }
    duration<double> longest_queue() const { return longest_queue_; }
    void forget_the_longest() { longest_queue_ = {}; }
    double carried(std::size_t end) const { return static_cast<double>(carried_.at(end)); }
    LinePace& end(std::size_t number) { return ends_.at(number); }
    Time now() const { return now_; }

private:
    struct Answer {
        std::uint64_t mark;
        std::size_t bytes;
        Time due;
    };
    void send(std::size_t i) {
        auto& pace = ends_[i];
        while (pace.may_send(pace.piece())) {
            const auto bytes = pace.piece();
            pace.sent(bytes, now_);
            free_ = std::max(free_, now_) +
                    std::chrono::duration_cast<Time::duration>(duration<double>(static_cast<double>(bytes) / rate_));
            unanswered_[i] += bytes;
            mark(i, false);
        }
        mark(i, true);
    }
    void mark(std::size_t i, bool blocked) {
        if (!ends_[i].wants_mark(blocked, now_)) return;
        answers_[i].push_back({ends_[i].next_mark(), std::exchange(unanswered_[i], 0), std::max(free_, now_) + way_});
        ends_[i].mark(now_);
    }
    void say_back(std::size_t i) {
        for (auto& answers = answers_[i]; !answers.empty() && answers.front().due <= now_; answers.pop_front()) {
            carried_[i] += answers.front().bytes;
            ends_[i].taken(answers.front().mark, now_);
        }
    }

    std::vector<LinePace> ends_;
    double rate_;
    milliseconds way_;
    Time now_ = Time{} + std::chrono::hours(1), free_ = now_;
    duration<double> longest_queue_{};
    std::vector<std::size_t> unanswered_ = std::vector<std::size_t>(ends_.size());
    std::vector<std::size_t> carried_ = std::vector<std::size_t>(ends_.size());
    std::vector<std::deque<Answer>> answers_ = std::vector<std::deque<Answer>>(ends_.size());
};

constexpr double megabit = 1e6 / 8;

class OfLines : public ::testing::TestWithParam<std::pair<double, milliseconds>> {};

TEST_P(OfLines, KeepsAHeartbeatFromWaitingLongAndTheLineBusy) {
    const auto [rate, way] = GetParam();
    SharedLine line(1, rate, way);
    line.pass(seconds(20));
    EXPECT_LT(line.longest_queue(), seconds(2)) << "before anything is known of it";
    line.forget_the_longest();
    const auto before = line.carried(0);
    line.pass(seconds(20));
    EXPECT_LT(line.longest_queue(), milliseconds(1100));
    EXPECT_GT(line.carried(0) - before, .8 * 20 * std::min(rate, 16e6 / std::chrono::duration<double>(way).count()));
}

INSTANTIATE_TEST_SUITE_P(SlowAndFastAndFar, OfLines,
                         ::testing::Values(std::pair{.25 * megabit, milliseconds(20)},
                                           std::pair{megabit, milliseconds(1)}, std::pair{megabit, milliseconds(300)},
                                           std::pair{20 * megabit, milliseconds(50)},
                                           std::pair{100 * megabit, milliseconds(200)}));

TEST(LinePace, SharesALineAmongMany) {
    SharedLine line(8, 2 * megabit, milliseconds(20));
    line.pass(seconds(10));
    line.forget_the_longest();
    line.pass(seconds(20));
    EXPECT_LT(line.longest_queue(), milliseconds(1200));
    for (std::size_t end = 0; end < 8; ++end)
        EXPECT_GT(line.carried(end), .2 * 30 * 2 * megabit / 8) << "end " << end << " got too little";
}

TEST(LinePace, LetsAFastLineBe) {
    SharedLine line(1, 10e9, milliseconds(1));
    line.pass(seconds(1));
    EXPECT_EQ(line.end(0).window(), LinePace::usual_window);
    EXPECT_EQ(line.end(0).piece(), LinePace::usual_window / 4) << "answers need not be cut up";
}

TEST(LinePace, TakesLittleThatIsSaidNowAndThenForNoFastLine) {
    LinePace pace;
    auto now = Time{} + std::chrono::hours(1);
    const auto before = pace.window();
    for (int i = 0; i < 1000; ++i) {
        now += milliseconds(60);
        pace.sent(1000, now);
        if (!pace.wants_mark(false, now)) continue;
        const auto mark = pace.next_mark();
        pace.mark(now);
        pace.taken(mark, now + milliseconds(8));
    }
    EXPECT_EQ(pace.window(), before);
}

TEST(LinePace, SendsOnePieceHoweverSlowTheLineIs) {
    LinePace pace;
    auto now = Time{} + std::chrono::hours(1);
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(pace.may_send(pace.piece()));
        pace.sent(pace.piece(), now);
        const auto mark = pace.next_mark();
        pace.mark(now);
        now += seconds(10);
        pace.taken(mark, now);
    }
    EXPECT_EQ(pace.window(), LinePace::least_piece);
}

TEST(LinePace, AsksAgainWhenAnAnswerWasLost) {
    LinePace pace;
    auto now = Time{} + std::chrono::hours(1);
    pace.sent(pace.window(), now);
    ASSERT_TRUE(pace.wants_mark(true, now));
    pace.mark(now);
    EXPECT_FALSE(pace.wants_mark(true, now + milliseconds(100)));
    EXPECT_TRUE(pace.wants_mark(true, now + seconds(10)));
}

TEST(LinePace, KnowsThatWhatIsUnderWayTakesTime) {
    LinePace pace;
    const auto now = Time{} + std::chrono::hours(1);
    EXPECT_EQ(pace.expected(), milliseconds(0)) << "nothing is under way";
    pace.sent(10000, now);
    const auto mark = pace.next_mark();
    pace.mark(now);
    EXPECT_GT(pace.expected(), seconds(1)) << "nobody knows yet";
    pace.taken(mark, now + milliseconds(2));
    pace.sent(10000, now + milliseconds(2));
    pace.mark(now + milliseconds(2));
    EXPECT_LT(pace.expected(), milliseconds(10)) << "it was fast";
}

}  // namespace
}  // namespace lightnet::line_pace_test
