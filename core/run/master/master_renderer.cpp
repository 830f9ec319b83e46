#include "core/run/master/master_renderer.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "core/run/schedule/guided.hpp"

namespace lightnet {
namespace {

constexpr double worth_the_way = 0.25;   // seconds of work: beside them, some hundred µs of sending are little
constexpr double soon_enough = 1;        // seconds until a group of blocks is there
constexpr double too_long = 1;           // seconds of one block of a tile: then it goes in pieces ...
constexpr double short_enough = 0.5;     // ... of about so many
constexpr std::size_t most_bytes = 4e6;  // of an answer of several tiles
constexpr std::size_t shares = 4;        // for each place, see guided_share()

}  // namespace

MasterRenderer::MasterRenderer(Job job, Carrier& carrier, Done done)
    : job_(std::move(job)),
      carrier_(carrier),
      done_(std::move(done)),
      channels_(carrier, job_.run, {}, counters_),
      edge_{job_.image, job_.credit, {}},
      left_(work_in(job_.tiles)),
      unanswered_(left_) {}

void MasterRenderer::use(const Plan& plan) {
    alone_each_ = job_.alone(plan);
    if (!std::exchange(planned_, true)) {
        MultiplexerRules rules;
        rules.scheduling.strategy = plan.strategy_of(job_.image);
        rules.scheduling.last_to_idle = true;
        rules.scheduling.double_tail = job_.double_tail;
        rules.clock = job_.clock;
        rules.at_fault = [this](const Failure& failure) { carrier_.take_out(failure.host, failure.why); };
        rules.checks = SpotChecks(job_.verify, secret_number());
        rules.own = "";
        rules.doubt = [this](Failure lie) {
            if (!alone_each_) lie.host.clear();
            carrier_.doubt(lie);
        };
        if (job_.check_answers) rules.differs = [this](const std::string& what) { error_ = what; };
        replicas_.follow(std::move(rules), &counters_);
    }
    channels_.connect(edge_, replicas_, plan);
}

void MasterRenderer::append(const std::vector<Tile>& tiles) {
    if (draining_) return;
    job_.tiles.insert(job_.tiles.end(), tiles.begin(), tiles.end());
    left_ += work_in(tiles);
    unanswered_ += work_in(tiles);
}

// How many blocks of samples go together: fewer towards the end.
// DECISIONS: quick-tiles-together
MasterRenderer::Together MasterRenderer::together() const {
    const double seconds = replicas_.scheduler().order().times().mean();  // of one block at one place
    const auto most =
        std::min(job_.credit.questions / job_.credit.bundles, guided_share(left_, replicas_.places(), shares));
    if (seconds <= 0 || most < 2) return {};
    const auto within = [&](double time) { return std::size_t(std::max(1.0, std::min(time / seconds, double(most)))); };
    return {within(worth_the_way), within(soon_enough)};
}

const Tile& MasterRenderer::next_tile() const { return pieces_.empty() ? job_.tiles[next_] : pieces_.back(); }

void MasterRenderer::pass_next_tile() {
    if (pieces_.empty())
        ++next_;
    else
        pieces_.pop_back();
}

// A tile that would take too long, into pieces; else only itself. What blocks of tiles cost is known of those lately.
std::vector<Tile> MasterRenderer::cut(const Tile& tile) {
    const double seconds = replicas_.scheduler().order().times().mean();
    if (seconds <= 0 || pixels_ <= 0 || tile.rehearses() || cut_tiles_.is_piece(tile)) return {tile};
    const double each = seconds / pixels_;
    if (each * static_cast<double>(tile.pixels()) <= too_long) return {tile};
    return cut_tiles_.cut(tile, static_cast<std::size_t>(short_enough / each));
}

// What goes together: one tile, or several quick ones. A group of blocks for which there is no time goes block by
// block.
std::vector<Tile> MasterRenderer::take_next() {
    if (!alone_.empty()) {
        const Tile tile = alone_.back();
        alone_.pop_back();
        return {tile};
    }
    const Together most = together();
    std::vector<Tile> tiles;
    std::size_t blocks = 0, bytes = 0;
    while (next_ < job_.tiles.size() || !pieces_.empty()) {
        const Tile tile = next_tile();
        bytes += answers_to(tile, job_.width) * sizeof(Rgb);
        if (!tiles.empty() && (blocks + tile.blocks() > most.quick || bytes > most_bytes)) break;
        pass_next_tile();
        if (tile.blocks() > most.of_group && !cut_tiles_.is_piece(tile)) {
            const auto pieces = one_by_one(tile);
            pieces_.insert(pieces_.end(), pieces.rbegin(), pieces.rend());
            bytes = 0;
            continue;
        }
        if (const auto pieces = cut(tile); pieces.size() > 1) {
            if (job_.handed_out) job_.handed_out({tile});
            pieces_.insert(pieces_.end(), pieces.rbegin(), pieces.rend());
            counters_.tiles -= pieces.size() - 1;  // places count each piece, and what is counted adds up to tiles
            left_ += work_in(pieces) - tile.blocks();
            unanswered_ += work_in(pieces) - tile.blocks();
            bytes = 0;
            continue;
        }
        tiles.push_back(tile);
        blocks += tile.blocks();
    }
    return tiles;
}

// Those who watch know whole tiles.
void MasterRenderer::show(std::vector<Tile> tiles) const {
    if (!job_.handed_out) return;
    std::erase_if(tiles, [this](const Tile& tile) { return cut_tiles_.is_piece(tile); });
    if (!tiles.empty()) job_.handed_out(tiles);
}

void MasterRenderer::hand_out() {
    replicas_.expect_hosts(carrier_.expects_hosts());
    replicas_.foresee(left_);
    while (left_ > 0 && replicas_.has_credit()) {
        auto tiles = std::make_shared<const std::vector<Tile>>(take_next());
        left_ -= work_in(*tiles);
        show(*tiles);
        replicas_.foresee(left_);
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
    pieces_.clear();
    alone_.clear();
    left_ = 0;
    replicas_.drop_waiting();
}

void MasterRenderer::answered(const Bundle<Tile>& bundle, std::vector<Rgb> pixels) {
    note_size(*bundle.questions);
    std::span<const Rgb> rest = pixels;
    for (const Tile& tile : *bundle.questions) {
        const std::size_t own = answers_to(tile, job_.width);
        unanswered_ -= tile.blocks();
        hand_on(tile, rest.first(own));
        rest = rest.subspan(own);
    }
}

// Of those whose time is known.
void MasterRenderer::note_size(const std::vector<Tile>& tiles) {
    double pixels = 0;
    for (const Tile& tile : tiles) pixels += static_cast<double>(tile.pixels() * tile.blocks());
    pixels /= static_cast<double>(work_in(tiles));
    pixels_ = pixels_ > 0 ? 0.8 * pixels_ + 0.2 * pixels : pixels;
}

void MasterRenderer::hand_on(const Tile& tile, std::span<const Rgb> pixels) {
    if (!cut_tiles_.is_piece(tile)) return done_(tile, pixels);
    if (const auto whole = cut_tiles_.put(tile, pixels)) done_(whole->tile, whole->pixels);
}

void MasterRenderer::failed(const Bundle<Tile>&, const Failure& failure) {
    if (error_.empty()) error_ = failure.why;
}

// Of several tiles, one may be to blame: each is tried alone.
void MasterRenderer::set_aside(const Bundle<Tile>& bundle, const std::string& why) {
    const auto& tiles = *bundle.questions;
    if (tiles.size() > 1 && !draining_) {
        alone_.insert(alone_.end(), tiles.rbegin(), tiles.rend());
        left_ += work_in(tiles);
        return;
    }
    unanswered_ -= work_in(tiles);
    set_aside_.push_back(why);
}

}  // namespace lightnet
