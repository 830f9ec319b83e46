#include "core/runtime/job.hpp"

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/scene/read_scene.hpp"

namespace lightnet {

using Json = nlohmann::json;

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
                  {"spare_fibers", rules.spare_fibers},
                  {"call_own_nodes", rules.call_own_nodes}}}}
        .dump();
}

Job job_from_json(std::string_view text) {
    try {
        const auto json = Json::parse(text);
        Job job;
        job.graph = graph_from_json(json.at("graph").dump());
        job.scene = json.at("scene");
        for (const auto& file : json.at("files")) {
            const auto hash = hash_from_hex(file.at("hash").get<std::string>());
            if (!hash) throw Error("a file of the job has no proper hash");
            job.files.push_back({file.at("path"), *hash, file.at("size")});
        }
        job.seed = json.at("seed");
        job.isa = json.at("isa");
        job.width = json.at("width");
        job.height = json.at("height");
        const auto& rules = json.at("rules");
        job.rules.bundles.questions = rules.at("questions");
        job.rules.bundles.oldest = std::chrono::microseconds(rules.at("oldest_us").get<std::int64_t>());
        job.rules.bundles.eager = rules.at("eager");
        job.rules.credit = {rules.at("credit_bundles"), rules.at("credit_questions")};
        job.rules.spare_fibers = rules.at("spare_fibers");
        job.rules.call_own_nodes = rules.at("call_own_nodes");
        return job;
    } catch (const Json::exception& error) {
        throw Error("not a job", error.what());
    }
}

std::shared_ptr<const Network> build_network(const Job& job, const Registry& registry, Files& files) {
    return build_network(job, registry, read_scene(files, job.scene));
}

std::shared_ptr<const Network> build_network(const Job& job, const Registry& registry, SceneData scene) {
    SceneOptions options;
    options.isa = job.isa;
    options.width = job.width;
    options.height = job.height;
    auto built = std::make_shared<const Scene>(std::move(scene), options);
    return std::make_shared<const Network>(Network{job.graph, registry, std::move(built), job.seed});
}

}  // namespace lightnet
