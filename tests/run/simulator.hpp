// A deterministic world of workers that are slow, hang, die, come and go behind a network that loses, delays, doubles
// and reorders, to put a MasterRenderer through. Same seed, same story, to the last byte.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <queue>
#include <random>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/run/master/master_renderer.hpp"
#include "tests/run/simulated_dispatcher.hpp"
#include "tests/run/simulated_world.hpp"

namespace lightnet::test {

/// Carries between a master and simulated hosts, on a clock of its own: waiting makes time pass. Hosts of several
/// places have real dispatchers, which deal to simulated places. Not a test: its rules are those of real carriers,
/// where only a reply proves anything.
class Simulator final : public Carrier {
public:
    explicit Simulator(World world) : world_(std::move(world)), random_(world_.seed) {
        for (std::uint32_t host = 0; host < world_.hosts; ++host) {
            hosts_.push_back({});
            hosts_.back().seconds_per_tile = world_.seconds_per_tile * (1 + 7 * part());
            hosts_.back().busy_until.assign(world_.places_per_host, 0);
            open(host);
            if (world_.stand_ins && host > 0) continue;  // nothing happens to those
            for (const auto& [kind, rate] : rates()) plan_next(kind, host, rate);
        }
        plan_changed(0);
    }

    double now() const { return now_; }
    /// The hosts that are there.
    Plan plan() const {
        Plan plan;
        plan.places_of.resize(1);
        plan.strategy = world_.strategy;
        for (std::uint32_t host = 0; host < hosts_.size(); ++host) {
            const auto state = hosts_[host].state;
            const bool asked = state == State::there && !(world_.stand_ins && !plan.places_of[0].empty() &&
                                                          plan.places[plan.places_of[0][0]].host != name(host));
            for (std::uint32_t place = 0; state != State::gone && place < world_.places_per_host; ++place) {
                if (asked) plan.places_of[0].push_back(static_cast<std::uint32_t>(plan.places.size()));
                plan.places.push_back({name(host), place});
            }
            plan.processes[name(host)] = hosts_[host].process;
        }
        return plan;
    }
    /// Everything that was sent and received, and when.
    std::string story() const { return story_.str(); }
    std::size_t events() const { return events_; }
    std::size_t asks() const { return asks_; }
    /// Of them, those that left the place to the host; and what its dispatcher asked of its places.
    std::size_t asked_of_hosts() const { return asked_of_hosts_; }
    std::size_t dealt() const { return dealt_; }
    /// Of all places together, when nothing happens to them.
    double tiles_per_second() const {
        double sum = 0;
        for (const auto& host : hosts_) sum += world_.places_per_host / host.seconds_per_tile;
        return sum;
    }
    /// In how many deaths each tile was under way on the host, and in how many as the only one.
    const std::map<std::uint32_t, int>& died_with() const { return died_with_; }
    const std::map<std::uint32_t, int>& died_alone() const { return died_alone_; }
    /// From now on nothing goes wrong any more.
    void calm_down() {
        world_.loss = world_.deaths = world_.cuts = world_.drains = world_.hangs = 0;
        for (auto& host : hosts_) host.hangs_until = std::min(host.hangs_until, now_);
    }

    bool ask(const PlaceAt& to, Message& message) override {
        const auto host = static_cast<std::uint32_t>(std::stoul(to.host));
        tell("ask", host, message.bundle);
        auto& tiles = out_[host][message.bundle];
        tiles.clear();
        for (const Tile& tile : *std::get<Questions<Tile>>(message.questions)) tiles.push_back(tile.x);
        ++asks_;
        if (to.index == any_place) ++asked_of_hosts_;
        if (lost()) return true;
        schedule({arrival(), Event::Kind::ask, host, hosts_[host].life, to.index, message});
        return true;
    }
    void reply(Message) override {}
    std::optional<Message> receive() override {
        if (arrived_.empty()) return std::nullopt;
        Message message = std::move(arrived_.front());
        arrived_.pop_front();
        return message;
    }
    void wait(std::chrono::nanoseconds most) override {
        const double until = now_ + std::chrono::duration<double>(most).count();
        while (arrived_.empty() && !queue_.empty() && queue_.top().time <= until) happen();
        if (arrived_.empty()) now_ = until;
    }
    void forget(const PlaceAt&) override {}
    const Counters& counters() const override { return counters_; }

private:
    enum class State { there, draining, gone };
    struct Host {
        std::unique_ptr<SimulatedDispatcher> dispatcher{};
        bool ticks = false;  // its next tick is to come
        State state = State::there;
        std::uint64_t life = 1;     // messages to an earlier one are lost
        std::uint64_t process = 1;  // it is another one after each death, but not after a cut
        double seconds_per_tile = 1;
        double hangs_until = 0;
        std::vector<double> busy_until;  // by place
    };
    struct Event {
        enum class Kind { ask, done, reply, tick, plan, death, cut, drain, hang, leave, back };
        double time;
        Kind kind;
        std::uint32_t host = 0;
        std::uint64_t life = 0;
        std::uint32_t place = 0;
        Message message;
        std::uint64_t order = 0;
        bool dealt = false;                         // by the dispatcher, which gets the answer
        bool operator<(const Event& other) const {  // the earliest is on top
            return time != other.time ? time > other.time : order > other.order;
        }
    };

    static std::string name(std::uint32_t host) { return std::to_string(host); }
    std::map<Event::Kind, double> rates() const {
        return {{Event::Kind::death, world_.deaths},
                {Event::Kind::cut, world_.cuts},
                {Event::Kind::drain, world_.drains},
                {Event::Kind::hang, world_.hangs}};
    }
    // Not the distributions of the library: those may differ from one to another.
    double part() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
    bool lost() { return world_.loss > 0 && part() < world_.loss; }
    double arrival() { return now_ + world_.delay * part(); }
    void plan_next(Event::Kind kind, std::uint32_t host, double rate) {
        if (rate > 0) schedule({now_ + 2 * part() / rate, kind, host, 0, 0, {}, 0});
    }
    void schedule(Event event) {
        event.order = next_order_++;
        queue_.push(std::move(event));
    }
    void tell(const char* what, std::uint32_t host, std::uint64_t bundle) {
        if (world_.remember) story_ << now_ << ' ' << what << ' ' << host << ' ' << bundle << '\n';
    }
    // The launcher learns of it some time later.
    void plan_changed(double after) {
        Event event{now_ + after, Event::Kind::plan, 0, 0, 0, {}, 0};
        schedule(std::move(event));
    }

    void happen() {
        Event event = queue_.top();
        queue_.pop();
        now_ = std::max(now_, event.time);
        if (++events_ > world_.most_events) throw std::runtime_error("nothing comes to an end");
        auto& host = hosts_[event.host];
        switch (event.kind) {
            case Event::Kind::ask:
                if (event.life == host.life && host.state != State::gone) take(event, host);
                break;
            case Event::Kind::tick:
                if (event.life == host.life) host.ticks = false, tick(event.host);
                break;
            case Event::Kind::done:
                if (event.life == host.life) finish(event, host);
                break;
            case Event::Kind::reply:
                tell("reply", event.host, event.message.bundle);
                out_[event.host].erase(event.message.bundle);
                arrived_.push_back(std::move(event.message));
                break;
            case Event::Kind::plan: {
                notice_deaths();
                Message message;
                message.type = Message::Type::plan;
                message.plan = std::make_shared<const Plan>(plan());
                arrived_.push_back(std::move(message));
                break;
            }
            case Event::Kind::death:
                if (host.state != State::gone && world_.deaths > 0 && now_ < world_.calm_after) die(event.host);
                plan_next(Event::Kind::death, event.host, world_.deaths);
                break;
            case Event::Kind::cut:
                if (host.state != State::gone && world_.cuts > 0 && now_ < world_.calm_after) {
                    tell("is cut off", event.host, 0);
                    go(event.host, 0);
                }
                plan_next(Event::Kind::cut, event.host, world_.cuts);
                break;
            case Event::Kind::drain:
                if (host.state == State::there && world_.drains > 0) {
                    host.state = State::draining;
                    tell("drains", event.host, 0);
                    plan_changed(0);
                    schedule(
                        {now_ + 20 * world_.seconds_per_tile, Event::Kind::leave, event.host, host.life, 0, {}, 0});
                }
                plan_next(Event::Kind::drain, event.host, world_.drains);
                break;
            case Event::Kind::hang:
                if (world_.hangs > 0) host.hangs_until = now_ + 100 * part();
                plan_next(Event::Kind::hang, event.host, world_.hangs);
                break;
            case Event::Kind::leave:
                if (event.life == host.life && host.state == State::draining) go(event.host, 0);
                break;
            case Event::Kind::back:
                host.state = State::there;
                tell("comes", event.host, 0);
                plan_changed(0);
                break;
        }
    }

    static const std::vector<Tile>& tiles_of(const Event& event) {
        return *std::get<Questions<Tile>>(event.message.questions);
    }

    void open(std::uint32_t number) {
        hosts_[number].ticks = false;
        hosts_[number].dispatcher = std::make_unique<SimulatedDispatcher>(
            name(number), world_.places_per_host, world_.strategy,
            SimulatedDispatcher::Hooks{[this, number](std::uint32_t place, Message& ask) { deal(number, place, ask); },
                                       [this, number](Message reply) {
                                           send_reply({now_, Event::Kind::reply, number, 0, 0, std::move(reply)});
                                       },
                                       [this] { return now_; }});
    }
    void take(Event& event, Host& host) {
        if (event.place != any_place) return begin(event, host);
        host.dispatcher->hear(std::move(event.message));
        tick(event.host);
    }
    // Time passes for a dispatcher as long as somebody waits for it.
    void tick(std::uint32_t number) {
        auto& host = hosts_[number];
        host.dispatcher->step();
        if (out_[number].empty() || std::exchange(host.ticks, true)) return;
        schedule({now_ + 1, Event::Kind::tick, number, host.life, 0, {}, 0});
    }
    void deal(std::uint32_t number, std::uint32_t place, Message& message) {
        ++dealt_;
        auto& host = hosts_[number];
        Event event{now_, Event::Kind::ask, number, host.life, place, std::move(message), 0, true};
        begin(event, host);
    }
    void send_reply(Event event) {
        const int copies = lost() ? 0 : 1 + (world_.twice > 0 && part() < world_.twice);
        for (int copy = 0; copy < copies; ++copy) {
            event.time = arrival();
            schedule(event);
        }
    }

    void begin(Event& event, Host& host) {
        auto& busy = host.busy_until[event.place];
        busy = std::max({busy, now_, host.hangs_until}) +
               host.seconds_per_tile * (0.5 + part()) * double(work_in(tiles_of(event)));
        event.time = busy;
        event.kind = Event::Kind::done;
        schedule(std::move(event));
    }

    void finish(Event& event, Host& host) {
        if (host.hangs_until > now_) {  // the answer is there when it wakes up
            event.time = host.hangs_until + world_.delay;
            return schedule(std::move(event));
        }
        Message reply = reply_to(event.message);
        for (const Tile& tile : tiles_of(event)) {
            if (world_.poisonous.contains(tile.x)) return die(event.host);
            reply.answers.push_back({static_cast<float>(tile.x), 1, 0});
        }
        reply.load = {0, static_cast<std::uint32_t>(std::min(4e9, host.seconds_per_tile * 1e9))};
        if (event.dealt) return host.dispatcher->hear(std::move(reply));
        event.kind = Event::Kind::reply;
        event.message = std::move(reply);
        send_reply(std::move(event));
    }

    void die(std::uint32_t host) {
        tell("dies", host, 0);
        ++hosts_[host].process;
        died_.insert(host);
        go(host, 1.5 * part());
    }
    void notice_deaths() {
        for (const auto host : std::exchange(died_, {})) {
            for (const auto& [bundle, tiles] : out_[host])
                for (const auto tile : tiles) {
                    ++died_with_[tile];
                    if (out_[host].size() == 1 && tiles.size() == 1) ++died_alone_[tile];
                }
            out_[host].clear();
        }
    }
    void go(std::uint32_t number, double noticed_after) {
        auto& host = hosts_[number];
        host.state = State::gone;
        ++host.life;
        host.busy_until.assign(world_.places_per_host, 0);
        over_.push_back(std::move(host.dispatcher));  // it may be what called us
        open(number);
        if (!died_.contains(number)) out_[number].clear();
        plan_changed(noticed_after);
        schedule({now_ + noticed_after + 0.1 + 5 * part(), Event::Kind::back, number, 0, 0, {}, 0});
    }

    World world_;
    std::mt19937_64 random_;
    double now_ = 0;
    std::vector<Host> hosts_;
    std::priority_queue<Event> queue_;
    std::deque<Message> arrived_;
    std::map<std::uint32_t, std::map<std::uint64_t, std::vector<std::uint32_t>>> out_;  // by host: asked, not answered
    std::set<std::uint32_t> died_;                                                      // and nobody knows
    std::map<std::uint32_t, int> died_with_, died_alone_;
    std::uint64_t next_order_ = 1;
    std::size_t events_ = 0, asks_ = 0, asked_of_hosts_ = 0, dealt_ = 0;
    std::ostringstream story_;
    Counters counters_;
    std::vector<std::unique_ptr<SimulatedDispatcher>> over_;  // of hosts that have gone
};

/// How a simulated run ended.
struct Told {
    std::map<std::uint32_t, std::uint32_t> folded;  // by tile: of how many blocks its pixels came
    double sum = 0;                                 // of the pixels, in the order of the tiles
    std::vector<std::string> set_aside;
    Counters counters;
    std::size_t outstanding = 0;
    double seconds = 0;
    double finished = 0;          // when the last pixels were there, seconds
    double tiles_per_second = 0;  // of all places together
    std::map<std::uint32_t, int> died_with, died_alone;
    std::size_t events = 0, asks = 0, asked_of_hosts = 0, dealt = 0;
    std::string story;
};

/// Runs a master until it has finished, or `most` simulated seconds are over.
inline Told play(const World& world, double most = 1e6) {
    Simulator simulator(world);
    MasterRenderer::Job job;
    job.credit = world.credit;
    job.clock = [&] { return simulator.now(); };
    job.check_answers = true;
    constexpr std::uint32_t first = 2 * blocks_per_group * samples_per_block;  // of a whole group
    for (std::uint32_t i = 0; i < world.tiles; ++i)
        job.tiles.push_back({i, 0, 1, 1, first, world.blocks * samples_per_block});
    Told told;
    std::map<std::uint32_t, float> pixels;
    MasterRenderer master(std::move(job), simulator, [&](const Tile& tile, std::span<const Rgb> colours) {
        told.folded[tile.x] += tile.blocks();
        pixels[tile.x] = colours[0].r;
    });
    master.use(simulator.plan());
    master.work(std::chrono::nanoseconds(static_cast<std::int64_t>(most * 1e9)));
    told.finished = simulator.now();
    told.tiles_per_second = simulator.tiles_per_second();
    for (const auto& [tile, value] : pixels) told.sum += value;
    told.set_aside = master.set_aside_tiles();
    told.seconds = simulator.now();
    told.counters = master.counters();
    // What was done twice may still be under way: its credit comes back too, by a reply or by time.
    simulator.calm_down();
    const double end = simulator.now() + 5000;
    while (master.outstanding() > 0 && simulator.now() < end) master.settle(std::chrono::seconds(1));
    told.outstanding = master.outstanding();
    told.died_with = simulator.died_with();
    told.died_alone = simulator.died_alone();
    told.events = simulator.events();
    told.asks = simulator.asks();
    told.asked_of_hosts = simulator.asked_of_hosts();
    told.dealt = simulator.dealt();
    told.story = simulator.story();
    return told;
}

}  // namespace lightnet::test
