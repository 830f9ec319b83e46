#include "core/runtime/master_renderer.hpp"

#include <algorithm>

#include "core/error.hpp"

namespace lightnet {
namespace {

constexpr double worth_the_way = 0.1;    // seconds of work: beside them, some hundred µs of sending are little
constexpr std::size_t most_bytes = 4e6;  // of an answer of several tiles
constexpr std::size_t shares = 8;        // of what is left, for each place: who ends last keeps nobody waiting long

}  // namespace

MasterRenderer::MasterRenderer(Job job, Carrier& carrier, Done done)
    : job_(std::move(job)),
      carrier_(carrier),
      done_(std::move(done)),
      channels_(carrier, job_.run, 0, counters_),
      edge_{job_.image, job_.credit, {}},
      unanswered_(job_.tiles.size()) {}

void MasterRenderer::use(const Plan& plan) {
    if (!std::exchange(planned_, true)) {
        MultiplexerRules rules;
        rules.scheduling.strategy = plan.strategy_of(job_.image);
        rules.scheduling.double_tail = job_.double_tail;
        rules.clock = job_.clock;
        if (job_.check) rules.differs = [this](const std::string& what) { error_ = what; };
        replicas_.follow(std::move(rules), &counters_);
    }
    channels_.connect(edge_, replicas_, plan);
}

void MasterRenderer::append(const std::vector<Tile>& tiles) {
    if (draining_) return;
    job_.tiles.insert(job_.tiles.end(), tiles.begin(), tiles.end());
    unanswered_ += tiles.size();
}

// How many tiles go together: of quick ones, several, but fewer towards the end (guided self-scheduling,
// Polychronopoulos & Kuck 1987).
std::size_t MasterRenderer::together() const {
    const auto left = job_.tiles.size() - next_;
    const double seconds = replicas_.scheduler().service() * double(replicas_.size());  // of one tile at one place
    const auto most = std::min(job_.credit.questions / job_.credit.bundles, left / (shares * replicas_.size()));
    if (seconds <= 0 || most < 2) return 1;
    const auto quick = std::max<std::size_t>(1, std::size_t(std::min(worth_the_way / seconds, double(most))));
    std::size_t count = 1, bytes = 0;
    while (count < quick) {
        bytes += answers_to(job_.tiles[next_ + count], job_.width) * sizeof(Rgb);
        if (bytes > most_bytes) break;
        ++count;
    }
    return count;
}

std::vector<Tile> MasterRenderer::take_next() {
    if (!alone_.empty()) {
        const Tile tile = alone_.back();
        alone_.pop_back();
        return {tile};
    }
    const auto first = job_.tiles.begin() + std::ptrdiff_t(next_);
    std::vector<Tile> tiles(first, first + std::ptrdiff_t(together()));
    next_ += tiles.size();
    return tiles;
}

void MasterRenderer::hand_out() {
    const auto left = [&] { return job_.tiles.size() - next_ + alone_.size(); };
    replicas_.foresee(left());
    while (left() > 0 && replicas_.has_credit()) {
        auto tiles = std::make_shared<const std::vector<Tile>>(take_next());
        replicas_.foresee(left());
        replicas_.send({std::move(tiles), this, 0, job_.width});
    }
    replicas_.tick();
}

void MasterRenderer::take_in() {
    while (auto message = carrier_.receive()) {
        if (message->run != job_.run) continue;
        if (message->type == Message::Type::plan)
            use(*message->plan);
        else if (message->type == Message::Type::reply || message->type == Message::Type::failure)
            channels_.arrived(*message);
        if (!error_.empty()) throw Error(error_);
    }
}

bool MasterRenderer::work(std::chrono::nanoseconds most) {
    const double end = job_.clock() + std::chrono::duration<double>(most).count();
    while (unanswered_ > 0) {
        hand_out();
        const double left = end - job_.clock();
        if (left <= 0) return false;
        carrier_.wait(std::min(std::chrono::nanoseconds(static_cast<std::int64_t>(left * 1e9)), replicas_.until_due()));
        take_in();
    }
    return true;
}

void MasterRenderer::settle(std::chrono::nanoseconds most) {
    const double end = job_.clock() + std::chrono::duration<double>(most).count();
    while (outstanding() > 0 && job_.clock() < end) {
        replicas_.tick();
        carrier_.wait(replicas_.until_due());
        take_in();
    }
}

void MasterRenderer::drain() {
    draining_ = true;
    next_ = job_.tiles.size();
    alone_.clear();
    replicas_.drop_waiting();
}

void MasterRenderer::answered(const Bundle<Tile>& bundle, std::vector<Rgb> pixels) {
    std::span<const Rgb> rest = pixels;
    for (const Tile& tile : *bundle.questions) {
        const std::size_t own = answers_to(tile, job_.width);
        --unanswered_;
        done_(tile, rest.first(own));
        rest = rest.subspan(own);
    }
}

void MasterRenderer::failed(const Bundle<Tile>&, const std::string& why) {
    if (error_.empty()) error_ = why;
}

// Of several tiles, one may be to blame: each is tried alone.
void MasterRenderer::set_aside(const Bundle<Tile>& bundle, const std::string& why) {
    const auto& tiles = *bundle.questions;
    if (tiles.size() > 1 && !draining_) {
        alone_.insert(alone_.end(), tiles.rbegin(), tiles.rend());
        return;
    }
    unanswered_ -= tiles.size();
    set_aside_.push_back(why);
}

}  // namespace lightnet
