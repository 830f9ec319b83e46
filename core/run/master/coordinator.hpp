// Leads all places of a run through preparing, and lets nobody ask a place that is not prepared.
#pragma once

#include <compare>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "core/run/assembly/prepare_progress.hpp"
#include "core/run/assembly/prepared.hpp"
#include "core/run/master/conducted_rehearsal.hpp"
#include "core/run/master/epoch.hpp"
#include "core/run/master/lock_client.hpp"
#include "core/run/master/service_calls.hpp"
#include "core/run/master/shard_work.hpp"
#include "core/run/message/carrier.hpp"

namespace lightnet {

/// What the carrier offers, and what can be asked of it by now.
struct CoordinatedPlans {
    Plan proposed, in_force;
    double enforced = 0;  // when
    double looked = 0;    // for copies that have left, when last
};

/// Stands between the run's carrier and the master renderer. Nodes prepare stage by stage, inputs first, see
/// stages_of(), each on all places that hold it: shards go to whoever is free, results are put together here, in order,
/// and brought to all. A stage ends when somebody can answer for each of its nodes: slower places join later.
/// The sectors of a sharded node prepare together, each in its own copies, which get their parts of the results alone.
/// A place that comes later is given the results, and is made known to the others when it has caught up. Belongs to the
/// launcher's thread.
///
/// What is proposed and what is in force: the carrier proposes a plan whenever hosts come or go. In force is the part
/// of it that can be asked: a place that is still behind is left out, and so is a node that was moved to a place and
/// is not prepared there yet.
class Coordinator final : public Carrier {
public:
    struct Options {
        std::uint64_t run = 0;
        const Graph* graph = nullptr;  // outlives the coordinator, like the registry
        const Registry* registry = nullptr;
        std::uint32_t width = 1;       // colours per pixel
        std::string made_from;         // see Recipes
        ResultCache* cache = nullptr;  // may be absent
        std::uint32_t verify = 0;      // millionths of the shards that two hosts are asked
        double let_go_after = 5;       // seconds, since a node has left a place: who has not heard yet may ask for it
        std::function<void(const std::string&)> say = [](const std::string&) {};
    };
    Coordinator(Options options, Carrier& carrier);
    ~Coordinator() override;

    /// What the carrier offers from now on.
    void propose(const Plan& plan);
    /// Leads on for about `most`. True when every node is prepared on some place: those that are behind are asked when
    /// they have caught up. Throws Error when a node failed.
    bool prepare(std::chrono::nanoseconds most);
    /// What is prepared from now on is for this pass of the picture: nodes that learn anew for each do so, and those
    /// that are prepared already stay. Work of the pass before must be done, and its master gone.
    void begin_pass(std::uint32_t pass);
    /// Another master is to follow the one before, when all is prepared: late replies to that are none to this.
    void begin_master() { epoch_.begin_next(); }
    /// What can be asked now, and what will be.
    const Plan& in_force() const { return plans_.in_force; }
    const Plan& proposed() const { return plans_.proposed; }
    /// How far preparing is. Of nodes that prepare at the same time, the first one.
    PrepareProgress progress() const;
    /// What was prepared: node → content hash of all its results.
    std::map<std::string, Hash> prepared() const { return calls_.hashes(); }

    /// The result of a node's last call, when it is prepared; null: it made none.
    Bytes last_result(std::size_t node) const { return calls_.last_result(node); }

    bool ask(const PlaceAt& to, Message& message) override;
    void reply(Message message) override { carrier_.reply(std::move(message)); }
    /// Work for the master; plans in force. Preparing goes on inside.
    std::optional<Message> receive() override;
    void wait(std::chrono::nanoseconds most) override;
    void give_up(std::uint32_t channel) override;
    bool take_out(const std::string& host, const std::string& why) override { return carrier_.take_out(host, why); }
    bool expects_hosts() const override { return carrier_.expects_hosts(); }
    void doubt(const Failure& lie) override { carrier_.doubt(lie); }
    std::uint64_t pulse(const std::string& host) const override { return carrier_.pulse(host); }
    void forget(const PlaceAt& place) override { carrier_.forget(place); }
    const Counters& counters() const override { return carrier_.counters(); }

private:
    /// A copy's prepare().
    struct Follower {
        enum class State { idle, asked, waiting, done };
        State state = State::idle;
        StepReport at;
        double left = 0;  // when the node left its place; 0: it is to be there
    };
    /// A step that was sent and not answered.
    struct Sent {
        NodeCopy to;
        std::size_t position;
        Step step;
    };
    bool is_renewed(std::size_t position) const { return calls_.is_renewed(order_[position]); }
    std::vector<std::size_t> nodes_at(std::size_t position) const;
    std::vector<NodeCopy> copies(std::size_t position) const;
    bool is_there(const NodeCopy& copy, std::size_t position) const;
    bool is_done(const NodeCopy& copy) const;
    const std::string& name_of(std::size_t position) const;
    void advance();
    std::size_t led() const;
    void lead(const NodeCopy& copy, std::size_t position);
    void deal(std::size_t position);
    void keep_dealing();
    bool end_calls();
    void doubt_shards(std::size_t node, Failure lie);
    bool will_join(const NodeCopy& copy, const ShardWork::Call& call) const;
    void collect();
    std::set<NodeCopy> waiting_to_rehearse();
    bool is_time_to_rehearse(const std::set<NodeCopy>& waiting);
    void begin_rehearsal(const std::set<NodeCopy>& taking_part);
    void end_rehearsal();
    bool send(const Sent& sent, const Bytes& data = nullptr);
    void take(Message message);
    void failed(const Sent& sent, const std::string& why);
    void reported(const Sent& sent, const Bytes& data);
    void let_go_of_taken(std::size_t position, std::uint32_t before);
    void say(std::size_t node, std::string_view lines);
    void noted(const Sent& sent, const Bytes& data);
    void lose(const std::set<PlaceAt>& gone);
    std::set<NodeCopy> copies_in_force(std::size_t position) const;
    bool can_be_asked(std::size_t position) const;
    std::set<PlaceAt> behind() const;
    std::set<NodeCopy> copies_to_ask(std::size_t position, const std::set<PlaceAt>& late) const;
    Plan restricted();
    void keep_where_it_was(Plan& plan, std::size_t position) const;
    void note_who_left(const Plan& before);
    void let_go_of_left();
    void enforce();

    Options options_;
    Carrier& carrier_;
    ServiceCalls calls_;
    ShardWork shards_;
    std::vector<std::size_t> order_;  // nodes that prepare; what stands for their sectors is found by nodes_at()
    std::vector<std::size_t> stages_;
    std::uint32_t pass_ = 0;
    std::optional<LockClient> locks_;  // none: nobody in the graph locks
    CoordinatedPlans plans_;
    std::deque<Message> arrived_;
    std::map<NodeCopy, Follower> followers_;
    std::map<std::uint64_t, Sent> sent_;
    using StepKey = std::tuple<std::size_t, Step::Kind, std::uint32_t>;  // position, kind, call
    std::map<StepKey, std::set<std::string>> failed_at_;                 // hosts
    std::uint64_t next_ = 1;
    std::size_t done_ = 0;                           // positions of order_ that can be asked
    std::set<PlaceAt> known_prepared_;               // had all that can be asked, once
    std::unique_ptr<ConductedRehearsal> rehearsal_;  // that goes on
    std::optional<double> first_waits_;              // since when somebody waits for the next one
    double went_on_ = steady_seconds();  // when something was there that nodes have to have in order to go on
    std::set<std::string> said_;
    Epoch epoch_;  // of the master whose replies count
};

}  // namespace lightnet
