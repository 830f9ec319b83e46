// What a host says to launchers, and does when they say something.
#include <algorithm>

#include "core/build_info.hpp"
#include "core/error.hpp"
#include "core/runtime/fingerprint.hpp"
#include "transport/host_service.hpp"

namespace lightnet {
namespace {

using packet::Fields;
using packet::Type;

}  // namespace

void Host::Service::control(const std::string& route, const packet::Header& header, const Fields& fields) {
    const bool ours = run && header.run == run->id();
    switch (header.type) {
        case Type::hello:
            return greet(route, fields);
        case Type::begin:
            return begin(route, header.run, fields);
        case Type::ping:
            return door.send(route, Type::pong, header.run,
                             Fields{}
                                 .set("process", process)
                                 .set("run", run ? run->id() : 0)
                                 .set("sent", fields.number("sent"))
                                 .set("line", door.tally().line)
                                 .set("taken", door.tally().taken)
                                 .set("told", door.tally().told)
                                 .set("progress", run && run->places() ? run->places()->progress() : 0));
        case Type::plan:
            if (ours) run->use(plan_from_json(fields.text("plan")));
            if (ours && leaving) leaving->known = true;
            return;
        case Type::status:
            return tell_state(route);
        case Type::expect:
            if (const auto hash = hash_from_hex(fields.text("hash")); ours && hash)
                run->expect(*hash, fields.number("size"));
            return tell_found();
        case Type::end:
            return end(route, header.run);
        default:
            return;
    }
}

void Host::Service::greet(const std::string& route, const Fields& fields) {
    if (leaving) return;  // whoever comes after it may serve
    if (fields.text("build") != build_id())
        return door.send(
            route, Type::refuse, 0,
            Fields{}.set("text", "builds differ: it runs " + build_id() + ", the launcher " + fields.text("build")));
    try {
        Fields answer;
        set(answer, machine);
        answer.set("places", options.places)
            .set("process", process)
            .set("fingerprint", fingerprint(fields.text("isa")));
        door.send(route, Type::welcome, 0, answer);
    } catch (const Error& error) {  // a processor without that instruction set
        door.send(route, Type::refuse, 0, Fields{}.set("text", error.what()));
    }
}

void Host::Service::begin(const std::string& route, std::uint64_t id, const Fields& fields) {
    if (leaving) return;
    if (run && run->id() != id)
        return door.send(
            route, Type::refuse, id,
            Fields{}.set("text", "it serves another run" + (who.empty() ? "" : ", of " + who)).set("busy", 1));
    if (!run) {
        Plan plan = plan_from_json(fields.text("plan"));
        // a hosts file may ask for more places than there are cores
        const auto mine = std::count_if(plan.places.begin(), plan.places.end(),
                                        [&](const PlaceAt& place) { return place.host == fields.text("you"); });
        HostedRun::Given job{id, fields.text("you"), std::max(options.places, static_cast<std::uint32_t>(mine)),
                             std::move(plan), job_from_json(fields.text("job"))};
        run = std::make_unique<HostedRun>(*context, cache, registry, std::move(job));
        relay = std::make_unique<RelayDoor>(*context, id);
        who = fields.text("who");
        given = answered = 0;
        options.log("serves a run" + (who.empty() ? "" : " of " + who));
    }
    launcher = route;
    door.count(route);
    heard = std::chrono::steady_clock::now();
    run->use(plan_from_json(fields.text("plan")));
    run->expect_files_anew();
    relay->say_again();
    if (run->state() != HostedRun::State::looking) tell_needs();
    if (run->serving()) door.send(route, Type::ready, id, {});  // the launcher had lost sight of us
}

void Host::Service::tell_needs() {
    std::string missing;
    for (const auto& hash : run->missing()) missing += to_hex(hash);
    door.send(launcher, Type::need, run->id(), Fields{}.set("hashes", missing));
}

void Host::Service::tell_found() {
    if (!run) return;
    for (const auto& [hash, here] : run->found())
        door.send(launcher, here ? Type::here : Type::lacks, run->id(), Fields{}.set("hash", to_hex(hash)));
}

void Host::Service::tell_state(const std::string& route) {
    Fields fields;
    set(fields, machine);
    fields.set("name", options.name.empty() ? machine.name : options.name).set("places", options.places);
    fields.set("state", leaving ? "leaves" : run ? run->words() : "is free").set("who", run ? who : "");
    fields.set("broken_packets", broken_packets);
    if (run) {
        fields.set("nodes", run->nodes()).set("bundles", given);
        fields.set("progress", run->places() ? run->places()->progress() : 0);
    }
    door.send(route, Type::state, run ? run->id() : 0, fields);
}

void Host::Service::take_blob(const std::string& route, std::uint64_t id, const packet::Piece& piece) {
    if (!run || run->id() != id) return;
    if (run->take_blob(piece))
        door.send(route, Type::blob_taken, id, Fields{}.set("hash", to_hex(piece.hash)).set("offset", piece.offset));
    tell_found();
}

Counters Host::Service::stop_run() {
    auto counters = run->stop();
    counters.broken_packets += std::exchange(broken_packets, 0);
    relay.reset();
    run.reset();
    cache.trim();
    return counters;
}

void Host::Service::end(const std::string& route, std::uint64_t id) {
    Counters counters;
    if (run && run->id() == id) {
        counters = stop_run();
        options.log("the run has ended");
    }
    Fields fields;
    for (const auto& [name, count] : counters.named()) fields.set(name, count);
    door.send(route, Type::ended, id, fields);
}

void Host::Service::drop_run(const std::string& why) {
    stop_run();
    options.log("the run is given up: " + why);
}

}  // namespace lightnet
