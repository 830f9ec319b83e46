#include "core/run/place/preparer.hpp"

#include <chrono>
#include <cstring>
#include <optional>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/words_of.hpp"
#include "core/film/tile.hpp"
#include "core/network/light/rehearsal.hpp"
#include "core/network/light/services.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

// Of the answer to one ask, beyond which no further shard is begun.
constexpr auto answer_worth_the_way =
    std::chrono::milliseconds(50);  // beside them, some hundred µs of sending are little
constexpr std::size_t most_answer_bytes = 4e6;

const Step& step_of(const Message& ask) { return std::get<Questions<Step>>(ask.questions)->front(); }

}  // namespace

/// One node's services at this place, and where its prepare() is.
class Preparer::Node final : public Services {
public:
    Node(Preparer& preparer, std::size_t index, std::uint32_t pass)
        : preparer_(preparer), index_(index), pass_(pass), call_(first_call_of(pass)) {}

    const char* name() const { return preparer_.network_.graph.nodes[index_].name.c_str(); }
    std::uint32_t pass() const { return pass_; }

    void prepare() {
        if (cancelled_) return;
        fiber_ = preparer_.fibers_.current();
        try {
            preparer_.assembly_.prepare(index_, *this, pass_);
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            failure_ = words_of(error);
        }
        preparer_.spent_[index_].ns += static_cast<std::uint64_t>(preparer_.fibers_.running_time(fiber_).count());
        if (failure_.empty() && sectors_) say_what_it_has();
        at_ = {StepReport::Kind::done, call_, 0};
        waiting_ = true;
        report();
    }

    // Another pass has begun: nobody waits for this one any more.
    void cancel() {
        cancelled_ = true;
        asked_.reset();
        if (!waiting_ || at_.kind == StepReport::Kind::done) return;
        waiting_ = false;
        resume_if_free();
    }

    // What is answered as soon as prepare() waits or has ended.
    void ask(Message ask) {
        asked_ = std::move(ask);
        if (waiting_) report();
    }

    void go_on(Message ask) {
        const Step step = step_of(ask);
        if (!waiting_ || at_.call != step.call || at_.kind == StepReport::Kind::done) return this->ask(std::move(ask));
        result_ = ask.data ? ask.data : preparer_.network_.results ? preparer_.network_.results(step.data) : nullptr;
        if (!result_) return fail(ask, "the result of a preparing step is not here");
        preparer_.spent_[index_].bytes += result_->size();
        asked_ = std::move(ask);
        waiting_ = false;
        resume_if_free();
    }

    void collect(Message ask) {
        const auto& noted = preparer_.assembly_.rehearsal(index_).noted();
        constexpr std::size_t most = (std::size_t{60} << 20) / sizeof(Query);
        if (noted.size() > most) return fail(ask, "a rehearsal noted too many questions");
        auto reply = reply_to(ask);
        reply.data = bytes_of(noted);
        preparer_.place_.reply(std::move(reply));
    }

    Bytes shards(const Step& step) {
        if (!waiting_ || (at_.kind != StepReport::Kind::map && at_.kind != StepReport::Kind::sectors) ||
            at_.call != step.call || step.first >= at_.count || step.count < 1 || step.count > at_.count - step.first)
            throw Error("it does not wait for these shards");
        // prepare() must stay where it is while its work is done: work looks at what lies on its stack.
        struct Busy {
            Node& node;
            explicit Busy(Node& n) : node(n) { ++node.shards_; }
            ~Busy() {
                --node.shards_;
                if (!node.waiting_) node.resume_if_free();
            }
        } busy(*this);
        ShardJoiner joined(step.count);
        const auto end = Clock::now() + answer_worth_the_way;
        std::size_t bytes = 0;
        for (std::uint32_t i = 0; i < step.count && waiting_; ++i) {
            look();
            std::vector<std::byte> results;
            (*work_)(step.first + i, results);
            joined.add(results);
            bytes += results.size();
            if (Clock::now() > end || bytes > most_answer_bytes) break;
        }
        return joined.finish();
    }

    std::vector<Query> rehearse(std::uint32_t stride) override {
        auto& rehearsal = preparer_.assembly_.rehearsal(index_);
        rehearsal.begin(preparer_.network_.renewed[index_] ? mark_of_pass(pass_) : std::uint16_t{0});
        const Mapped<Query> noted(wait(StepReport::Kind::rehearse, stride));
        rehearsal.end();
        return {noted.begin(), noted.end()};
    }
    void say(const std::string& text) override { said_ += text + '\n'; }
    void doing(const std::string& what, std::uint64_t done, std::uint64_t total) override {
        look();
        counts_ = total > 0;
        preparer_.network_.activity->set(written_name(), {what, done, total});
    }
    void look() const override { preparer_.place_.look(); }

protected:
    Bytes map_bytes(std::size_t count, const Shard& work) override {
        work_ = &work;
        return wait(StepReport::Kind::map, static_cast<std::uint32_t>(count));
    }
    const Sectors* sectors() override {
        if (!sectors_ && sector_at(preparer_.network_.graph, index_)) sectors_ = preparer_.network_.sectors(index_);
        return sectors_.get();
    }
    Bytes map_sectors(std::size_t count, const Shard& work) override {
        work_ = &work;
        auto near = wait(StepReport::Kind::sectors, static_cast<std::uint32_t>(count));
        near_bytes_ += near->size();
        return near;
    }
    std::shared_ptr<const void> once_any(const Make& make) override {
        const auto watch = [this](std::size_t done, std::size_t count) {
            look();
            if (!counts_) preparer_.network_.activity->set(written_name(), done, count);
        };
        return preparer_.network_.shared->get(index_, values_++, watch, make, pass_);
    }

private:
    // A sector goes by the name that the user wrote.
    const std::string& written_name() const {
        const auto& graph = preparer_.network_.graph;
        return graph.nodes[whole_of(graph, index_)].name;
    }

    // What a sector costs in memory is why nodes are sharded.
    void say_what_it_has() {
        const auto* sector = sector_at(preparer_.network_.graph, index_);
        say("took in " + std::to_string((near_bytes_ + 999999) / 1000000) + " MB for sector " +
            std::to_string(sector->index + 1) + " of " + std::to_string(sector->count));
    }

    Bytes wait(StepReport::Kind kind, std::uint32_t count) {
        if (!counts_) preparer_.network_.activity->set(written_name(), 0, 0);  // the launcher counts
        if (cancelled_) throw Cancelled{};
        at_ = {kind, call_++, count};
        if (is_first_call(call_)) throw Error("it calls its services too often");
        auto& spent = preparer_.spent_[index_];
        if (kind != StepReport::Kind::rehearse) spent.shards += count;
        ++spent.rounds;
        waiting_ = true;
        report();
        preparer_.fibers_.park();
        if (cancelled_) throw Cancelled{};
        return std::exchange(result_, nullptr);
    }

    void report() {
        if (!asked_) return;
        auto ask = *std::exchange(asked_, std::nullopt);
        if (!failure_.empty()) return fail(ask, failure_);
        auto reply = reply_to(ask);
        auto data = std::make_shared<std::vector<std::byte>>(sizeof at_ + said_.size());
        std::memcpy(data->data(), &at_, sizeof at_);
        std::memcpy(data->data() + sizeof at_, said_.data(), said_.size());
        said_.clear();
        reply.data = std::move(data);
        preparer_.place_.reply(std::move(reply));
    }

    void fail(Message& ask, const std::string& why) {
        auto reply = reply_to(ask);
        reply.type = Message::Type::failure;
        reply.trouble.why = "on " + preparer_.place_.name + ": " + why;
        preparer_.place_.reply(std::move(reply));
    }

    void resume_if_free() {
        if (shards_ == 0) preparer_.place_.resume(fiber_);
    }

    Preparer& preparer_;
    std::size_t index_;
    std::uint32_t pass_;
    bool cancelled_ = false;
    Fibers::Fiber* fiber_ = nullptr;
    std::optional<Message> asked_;  // the step that the next report answers
    StepReport at_;
    bool counts_ = false;   // it says itself how much is done
    bool waiting_ = false;  // at at_, for a result, or for nothing more
    std::string failure_, said_;
    const Shard* work_ = nullptr;
    std::size_t shards_ = 0;  // that are being done
    Bytes result_;
    std::uint32_t call_, values_ = 0;
    std::shared_ptr<const Sectors> sectors_;
    std::size_t near_bytes_ = 0;  // of results of its sector
};

Preparer::Preparer(const Network& network, Assembly& assembly, Fibers& fibers, PlaceHooks place)
    : network_(network), assembly_(assembly), fibers_(fibers), place_(std::move(place)) {}

Preparer::~Preparer() = default;

// Its fiber may still be on its way out: it has itself as long.
void Preparer::leave(Message ask) {
    if (const auto known = nodes_.find(ask.node); known != nodes_.end()) {
        known->second->cancel();
        nodes_.erase(known);
    }
    left_.insert(ask.node);
    to_let_go_.push_back(std::move(ask));
}

bool Preparer::let_go() {
    const auto ready =
        std::ranges::find_if(to_let_go_, [&](const Message& ask) { return !place_.owes_answers(ask.node); });
    if (ready == to_let_go_.end()) return false;
    const auto node = ready->node;
    assembly_.leave(node);
    place_.reply(reply_to(*ready));
    to_let_go_.erase(ready);
    std::deque<Message> waited;
    std::erase_if(to_let_go_,
                  [&](Message& ask) { return ask.node == node && (waited.push_back(std::move(ask)), true); });
    for (auto& ask : waited) take(std::move(ask));
    return true;
}

void Preparer::take(Message ask) {
    const std::size_t index = ask.node;
    const auto is_of_it = [&](const Message& other) { return other.node == index; };
    if (std::ranges::any_of(to_let_go_, is_of_it)) return to_let_go_.push_back(std::move(ask));
    if (step_of(ask).kind == Step::Kind::leave) return leave(std::move(ask));
    const auto pass = pass_of_call(step_of(ask).call);
    auto& known = nodes_[index];
    if (known && pass < known->pass()) return;  // nobody waits for the answer any more
    if (!known || pass > known->pass()) {
        if (known) known->cancel();
        known = std::make_shared<Node>(*this, index, pass);
        left_.erase(index);
        to_start_.push_back(known);
    }
    switch (step_of(ask).kind) {
        case Step::Kind::go_on:
            return known->go_on(std::move(ask));
        case Step::Kind::collect:
            return known->collect(std::move(ask));
        default:
            return known->ask(std::move(ask));
    }
}

std::uint64_t Preparer::result_bytes() const {
    std::uint64_t bytes = 0;
    for (const auto& [node, spent] : spent_) bytes += spent.bytes;
    return bytes;
}

bool Preparer::start_next() {
    if (let_go()) return true;
    if (to_start_.empty()) return false;
    const auto node = to_start_.front();
    to_start_.pop_front();
    fibers_.start(node->name(), [node] { node->prepare(); });
    return true;
}

Bytes Preparer::shards(std::size_t node, const Step& step) {
    const auto found = nodes_.find(node);
    if (found == nodes_.end()) throw Error("it has not begun to prepare");
    const auto preparing = found->second;  // stays while it works, whatever pass begins meanwhile
    return preparing->shards(step);
}

}  // namespace lightnet
