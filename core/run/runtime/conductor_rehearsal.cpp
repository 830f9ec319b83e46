// How a conductor leads rehearsals.
#include <algorithm>
#include <cstring>
#include <span>

#include "core/network/light/mapped.hpp"
#include "core/network/light/rehearsal.hpp"
#include "core/run/runtime/conductor.hpp"

namespace lightnet {
namespace {

constexpr std::uint32_t tiles_per_place = 4;  // small ones, or bundles of them

}  // namespace

// Begins a rehearsal when all copies of the node wait for it, and gathers what they have noted when it is over.
void Conductor::collect() {
    if (done_ == order_.size()) return;
    if (!rehearsing_) {
        const auto all = copies(done_);
        if (all.empty()) return;
        const auto call = followers_[all[0]].at.call;
        for (const auto& copy : all) {
            const auto& follower = followers_[copy];
            if (follower.state != Follower::State::waiting || follower.at.kind != StepReport::Kind::rehearse ||
                follower.at.call != call || calls_.reported(copy.node, follower.at).done())
                return;
        }
        return begin_rehearsal(call);
    }
    if (!rehearsing_->rendered || rehearsing_->broken) return;
    for (const auto& copy : rehearsing_->copies)
        if (!rehearsing_->collecting.contains(copy) &&
            send(copy, done_, {.kind = Step::Kind::collect, .call = rehearsing_->call, .first = epoch_.number()}))
            rehearsing_->collecting.insert(copy);
}

void Conductor::begin_rehearsal(std::uint32_t call) {
    MasterRenderer::Job job;
    job.run = options_.run;
    job.image = static_cast<std::uint32_t>(renderer_of(*options_.graph, *options_.registry));
    job.width = options_.width;
    job.tiles = rehearsal_tiles(*options_.graph, *options_.registry, calls_.of(order_[done_], call).what().count);
    job.credit = {tiles_per_place, tiles_per_place * MasterRenderer::most_together};
    job.double_tail = false;  // what is still under way at its end would note questions in the next rehearsal
    epoch_.begin_next();
    rehearsing_.emplace();
    rehearsing_->call = call;
    rehearsing_->blocks = work_in(job.tiles);
    for (const auto& copy : copies(done_)) rehearsing_->copies.insert(copy);
    rehearsing_->master =
        std::make_unique<MasterRenderer>(std::move(job), *this, [](const Tile&, std::span<const Rgb>) {});
    enforce();  // who could not be asked because of the rehearsal before can be now
    rehearsing_->master->use(in_force_);
}

void Conductor::noted(const Sent& sent, const Bytes& data) {
    // What was noted in one that was broken off, perhaps of the same call, does not count.
    if (!rehearsing_ || rehearsing_->broken || sent.step.first != epoch_.number()) return;
    auto& all = rehearsing_->noted;
    const std::size_t before = all.size();
    all.resize(before + (data ? data->size() / sizeof(Query) : 0));
    if (all.size() > before) std::memcpy(&all[before], data->data(), (all.size() - before) * sizeof(Query));
    if (++rehearsing_->collected < rehearsing_->copies.size()) return;
    sort_and_unite(rehearsing_->noted);
    const auto bytes = std::as_bytes(std::span(rehearsing_->noted));
    const std::vector<std::byte> shard(bytes.begin(), bytes.end());
    end_rehearsal();
    calls_.of(order_[sent.position], sent.step.call).complete(join_shards(std::span(&shard, 1)));
    calls_.keep(order_[sent.position], sent.step.call);
    advance();
}

void Conductor::end_rehearsal() {
    rehearsing_.reset();
    epoch_.begin_next();
}

}  // namespace lightnet
