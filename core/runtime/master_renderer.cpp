#include "core/runtime/master_renderer.hpp"

#include "core/error.hpp"

namespace lightnet {

MasterRenderer::MasterRenderer(Job job, Carrier& carrier, Done done)
    : job_(std::move(job)), carrier_(carrier), done_(std::move(done)), unanswered_(job_.tiles.size()) {}

void MasterRenderer::use(const Plan& plan) {
    std::map<std::pair<std::string, std::uint32_t>, std::uint32_t> places;
    std::vector<Channel<Tile>*> replicas;
    for (const auto place : plan.places_of[job_.image]) {
        const auto& at = plan.places[place];
        const std::pair key{at.host, at.index};
        if (const auto known = places_.find(key); known != places_.end()) {
            places.insert(*known);
        } else {
            places[key] = static_cast<std::uint32_t>(channels_.size());
            channels_.push_back(std::make_unique<RemoteChannel<Tile>>(
                carrier_, RemoteChannel<Tile>::Ends{job_.run, places[key], job_.image, at}, job_.credit, counters_));
        }
        replicas.push_back(channels_[places[key]].get());
    }
    const auto before = std::exchange(places_, std::move(places));
    replicas_.use(std::move(replicas));
    for (const auto& [key, number] : before)
        if (!places_.contains(key)) channels_[number]->close();
}

void MasterRenderer::append(const std::vector<Tile>& tiles) {
    if (draining_) return;
    job_.tiles.insert(job_.tiles.end(), tiles.begin(), tiles.end());
    unanswered_ += tiles.size();
}

void MasterRenderer::hand_out() {
    while (replicas_.has_credit()) {
        if (again_.empty()) {
            if (next_ == job_.tiles.size()) return;
            auto tile = std::make_shared<const std::vector<Tile>>(1, job_.tiles[next_]);
            again_.push_back({std::move(tile), this, next_, job_.width});
            ++next_;
        }
        if (!replicas_.send(again_.front())) return;
        again_.pop_front();
    }
}

bool MasterRenderer::work(std::chrono::nanoseconds most) {
    const auto end = std::chrono::steady_clock::now() + most;
    while (unanswered_ > 0) {
        hand_out();
        const auto left = end - std::chrono::steady_clock::now();
        if (left.count() <= 0) return false;
        carrier_.wait(std::min<std::chrono::nanoseconds>(left, std::chrono::milliseconds(again_.empty() ? 100 : 2)));
        while (auto message = carrier_.receive()) {
            if (message->run != job_.run) continue;
            if (message->type == Message::Type::plan) {
                use(*message->plan);
            } else if (message->channel < channels_.size() &&
                       (message->type == Message::Type::reply || message->type == Message::Type::failure)) {
                channels_[message->channel]->arrived(*message);
            }
            if (!error_.empty()) throw Error(error_);
        }
    }
    return true;
}

void MasterRenderer::answered(const Bundle<Tile>& bundle, std::vector<Rgb> pixels) {
    --unanswered_;
    done_(bundle.questions->front(), pixels);
}

void MasterRenderer::failed(const Bundle<Tile>&, const std::string& why) {
    if (error_.empty()) error_ = why;
}

}  // namespace lightnet
