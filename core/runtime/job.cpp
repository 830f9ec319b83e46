#include "core/runtime/job.hpp"

#include <limits>
#include <nlohmann/json.hpp>

#include "core/build_info.hpp"
#include "core/error.hpp"
#include "core/prepare/load_scene.hpp"

namespace lightnet {

using Json = nlohmann::json;

namespace {

// A graph's own 32 levels, and those around it: what is nested deeper can't be told apart from an attack on the stack.
constexpr int most_depth = 40;

Json parse(std::string_view text) {
    return Json::parse(text, [](int depth, Json::parse_event_t, const Json&) {
        if (depth > most_depth) throw Error("not a job", "nested too deeply");
        return true;
    });
}

template <class Integer>
Integer count_of(const Json& object, const char* key) {
    const auto& number = object.at(key);
    if (!number.is_number_unsigned() || number.get<std::uint64_t>() > std::numeric_limits<Integer>::max())
        throw Error("not a job", std::string("'") + key + "' is no count");
    return number.get<Integer>();
}

}  // namespace

std::string to_json(const Job& job) {
    Json files = Json::array();
    for (const auto& file : job.files)
        files.push_back({{"path", file.path}, {"hash", to_hex(file.hash)}, {"size", file.size}});
    const auto& rules = job.rules;
    return Json{{"graph", Json::parse(to_json(job.graph))},
                {"scene", job.scene},
                {"files", std::move(files)},
                {"seed", job.seed},
                {"isa", job.isa},
                {"width", job.width},
                {"height", job.height},
                {"rules",
                 {{"questions", rules.bundles.questions},
                  {"oldest_us", rules.bundles.oldest.count()},
                  {"eager", rules.bundles.eager},
                  {"credit_bundles", rules.credit.bundles},
                  {"credit_questions", rules.credit.questions},
                  {"credit_bytes", rules.credit.bytes},
                  {"spare_fibers", rules.spare_fibers},
                  {"side_fibers", rules.side_fibers},
                  {"check", rules.check},
                  {"call_own_nodes", rules.call_own_nodes}}},
                {"checking", job.checking}}
        .dump();
}

Job job_from_json(std::string_view text) {
    try {
        const auto json = parse(text);
        Job job;
        job.graph = graph_from_json(json.at("graph").dump());
        job.scene = json.at("scene");
        for (const auto& file : json.at("files")) {
            const auto hash = hash_from_hex(file.at("hash").get<std::string>());
            if (!hash) throw Error("a file of the job has no proper hash");
            job.files.push_back({file.at("path"), *hash, count_of<std::uint64_t>(file, "size")});
        }
        job.seed = count_of<std::uint64_t>(json, "seed");
        job.isa = json.at("isa");
        job.width = count_of<std::uint32_t>(json, "width");
        job.height = count_of<std::uint32_t>(json, "height");
        const auto& rules = json.at("rules");
        job.rules.bundles.questions = count_of<std::size_t>(rules, "questions");
        job.rules.bundles.oldest = std::chrono::microseconds(count_of<std::uint32_t>(rules, "oldest_us"));
        job.rules.bundles.eager = count_of<std::size_t>(rules, "eager");
        job.rules.credit.bundles = count_of<std::size_t>(rules, "credit_bundles");
        job.rules.credit.questions = count_of<std::size_t>(rules, "credit_questions");
        job.rules.credit.bytes = count_of<std::size_t>(rules, "credit_bytes");
        job.rules.spare_fibers = count_of<std::size_t>(rules, "spare_fibers");
        job.rules.side_fibers = count_of<std::size_t>(rules, "side_fibers");
        job.rules.check = rules.at("check");
        job.rules.call_own_nodes = rules.at("call_own_nodes");
        job.checking = json.at("checking");
        return job;
    } catch (const Json::exception& error) {
        throw Error("not a job", error.what());
    }
}

std::shared_ptr<const Network> build_network(const Job& job, const Registry& registry, Files& files,
                                             std::function<Bytes(const Hash&)> results) {
    return build_network(job, registry, load_scene(job.graph, registry, files, job.scene), std::move(results));
}

std::shared_ptr<const Network> build_network(const Job& job, const Registry& registry, SceneData scene,
                                             std::function<Bytes(const Hash&)> results) {
    SceneOptions options;
    options.isa = job.isa;
    options.width = job.width;
    options.height = job.height;
    try {
        Network network{job.graph, registry, std::make_shared<const Scene>(std::move(scene), options), job.seed};
        network.results = std::move(results);
        network.checking = job.checking;
        return std::make_shared<const Network>(std::move(network));
    } catch (const std::bad_alloc&) {
        throw Error(job.scene, "is too large for the memory of this machine, with what finds its surfaces");
    }
}

std::string made_from(const Job& job) {
    std::string text = build_id() + '\n' + job.isa + '\n' + std::to_string(job.seed) + '\n' + job.scene;
    for (const auto& file : job.files) text += '\n' + file.path + ' ' + to_hex(file.hash);
    return text;
}

}  // namespace lightnet
