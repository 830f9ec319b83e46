#include "core/run/assembly/job.hpp"

#include "core/base/build_info.hpp"
#include "core/base/error.hpp"
#include "core/base/json_tree.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/network/graph/json.hpp"
#include "core/network/graph/lamp_groups.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/plugin_use.hpp"
#include "core/scene/camera_in.hpp"
#include "core/scene/data/same_shapes.hpp"

namespace lightnet {

namespace {

// Around the graph's own levels.
constexpr JsonLimits job_limits{.bytes = most_job_bytes, .depth = JsonLimits{}.depth + 4};

[[noreturn]] void not_a_job(const std::string& what) { throw Error("not a job", what); }

template <class Integer>
Integer count_of(const Json& object, const char* key) {
    try {
        return object.at(key).whole<Integer>();
    } catch (const Error& error) {
        not_a_job(std::string("'") + key + "' is no count: " + error.what());
    }
}

JsonTree json_of(const Tuning& tuning) {
    JsonTree json;
    for (const auto& knob : knobs)
        if (knob.where == Knob::Where::places)
            std::visit([&](const auto& member) { json[knob.name] = tuning.*member; }, knob.member);
    return json;
}

void take(const Json& json, const Knob& knob, std::string& text) { text = json.at(knob.name).text(); }
void take(const Json& json, const Knob& knob, bool& flag) { flag = json.at(knob.name).flag(); }
template <class Integer>
void take(const Json& json, const Knob& knob, Integer& number) {
    number = count_of<Integer>(json, knob.name);
    if (number < knob.least || number > knob.most)  // a stranger's job may ask for any number of fibers
        not_a_job(std::string("'") + knob.name + "' is " + std::to_string(number) + ", and goes from " +
                  std::to_string(knob.least) + " to " + std::to_string(knob.most));
}

Tuning tuning_of(const Json& json) {
    Tuning tuning;
    for (const auto& knob : knobs)
        if (knob.where == Knob::Where::places)
            std::visit([&](const auto& member) { take(json, knob, tuning.*member); }, knob.member);
    return tuning;
}

JobFile file_of(const Json& json) {
    const auto hash = hash_from_hex(json.at("hash").text());
    if (!hash) not_a_job("a file of it has no proper hash");
    return {text_from_json(json.at("path")), *hash, count_of<std::uint64_t>(json, "size")};
}

SceneOptions scene_options(const Job& job) {
    SceneOptions options;
    options.isa = job.isa;
    options.width = job.width;
    options.height = job.height;
    return options;
}

std::shared_ptr<const Network> network_around(const Job& job, const Registry& registry,
                                              std::shared_ptr<const Scene> scene, KeptResults kept,
                                              std::function<Bytes(const Hash&)> results) {
    Network network{job.graph, registry, std::move(scene), job.seed};
    network.results = std::move(results);
    network.kept = std::move(kept);
    network.check_answers = job.tuning.check_answers;
    return std::make_shared<const Network>(std::move(network));
}

}  // namespace

std::string to_json(const Job& job) {
    JsonTree files = JsonTree::list();
    for (const auto& file : job.files)
        files.push_back({{"path", tree_of_text(file.path)}, {"hash", to_hex(file.hash)}, {"size", file.size}});
    const auto rest = to_text({{"scene", tree_of_text(job.scene)},
                               {"files", std::move(files)},
                               {"seed", job.seed},
                               {"isa", job.isa},
                               {"width", job.width},
                               {"height", job.height},
                               {"tuning", json_of(job.tuning)},
                               {"plugins", job.plugins}},
                              {.by_name = true, .strict = true});
    return "{\"graph\":" + to_json(job.graph) + "," + rest.substr(1);  // which is text already
}

Job job_from_json(std::string_view text) {
    const Json json = parse_json(text, job_limits);
    Job job;
    job.graph = graph_from_json(json.at("graph"));
    job.scene = text_from_json(json.at("scene"));
    for (const auto& file : json.at("files").list()) job.files.push_back(file_of(file));
    job.seed = count_of<std::uint64_t>(json, "seed");
    job.isa = json.at("isa").text();
    job.width = count_of<std::uint32_t>(json, "width");
    job.height = count_of<std::uint32_t>(json, "height");
    job.tuning = tuning_of(json.at("tuning"));
    for (const auto& plugin : json.at("plugins").list()) job.plugins.push_back(plugin.text());
    return job;
}

Job read_job(std::string_view text, const Registry& registry) {
    Job job = job_from_json(text);
    const auto is_side = [](std::uint32_t pixels) { return 1 <= pixels && pixels <= longest_side; };
    if (!is_side(job.width) || !is_side(job.height)) not_a_job("its picture has a side that no picture has");
    if (const auto why = why_plugins_differ(job.plugins, registry); !why.empty()) throw Error(why);
    try {
        job.graph = check(job.graph, registry);
    } catch (const UserError& error) {
        throw Error("the job's graph is not sound", error.what());
    }
    return job;
}

std::shared_ptr<const Network> build_network(const Job& job, const Registry& registry, Files& files,
                                             std::function<Bytes(const Hash&)> results) {
    return build_network(job, registry, load_scene(job.graph, registry, files, job.scene), std::move(results));
}

std::shared_ptr<const Network> build_network(const Job& job, const Registry& registry, LoadedScene scene,
                                             std::function<Bytes(const Hash&)> results) {
    if (scene.built)
        return network_around(job, registry, std::move(scene.built), std::move(scene.kept), std::move(results));
    try {
        auto built = std::make_shared<const Scene>(std::move(scene.data), scene_options(job));
        return network_around(job, registry, std::move(built), std::move(scene.kept), std::move(results));
    } catch (const std::bad_alloc&) {
        throw Error(job.scene, "is too large for the memory of this machine, with what finds its surfaces");
    }
}

std::shared_ptr<const Network> build_network(const Job& job, const Registry& registry,
                                             std::shared_ptr<const Scene> built,
                                             std::function<Bytes(const Hash&)> results) {
    std::vector<Problem> problems;
    find_mistakes(job.graph, registry, built->data(), problems);
    if (!problems.empty()) throw UserError(std::move(problems));
    return network_around(job, registry, std::move(built), {}, std::move(results));
}

SceneSource scene_source(const Job& job, const Registry& registry) {
    const Node& node = scene_of(job.graph, registry);
    SceneSource source{job.graph.file, job.scene, job.files, node.entries, node.params, {}, {},
                       job.isa,        job.width, job.height};
    for (const char* name : {"camera", "next_camera", "previous_camera", "seen_by", "exposure"})
        if (auto param = source.params.extract(name)) source.sight.insert(std::move(param));
    for (const char* name : {"lamps", "colours", "roughness", "environment_scale"})
        if (auto param = source.params.extract(name)) source.edits.insert(std::move(param));
    return source;
}

bool SceneSource::is_but_for_sight(const SceneSource& other) const {
    SceneSource same = *this;
    same.sight = other.sight;
    return same == other;
}

bool SceneSource::is_but_for_edits(const SceneSource& other) const {
    SceneSource same = *this;
    same.edits = other.edits;
    return same.is_but_for_sight(other);
}

std::shared_ptr<const Scene> edited(const Job& job, const Registry& registry, const Scene& built) {
    const auto onlooker = another_look(job.graph, registry, built.data());
    if (!onlooker || !may_be_edited(built.data())) return nullptr;
    SceneData data = with_vertices(built.data(), built.data().unedited->vertices);
    edit_again(job.graph, registry, data);
    data.camera = onlooker->camera, data.camera_given = true, data.film = onlooker->film;
    return std::make_shared<const Scene>(std::move(data), scene_options(job));
}

std::shared_ptr<const Scene> seen_by(const Job& job, const Registry& registry, const Scene& built) {
    const auto onlooker = another_look(job.graph, registry, built.data());
    return onlooker ? std::make_shared<const Scene>(built, *onlooker, scene_options(job)) : nullptr;
}

MadeFrom made_from(const Job& job) {
    MadeFrom made(build_id() + '\n' + job.isa + '\n' + std::to_string(job.seed));
    for (const auto& plugin : job.plugins) made.run += '\n' + plugin;
    made.files = job.scene;
    for (const auto& file : job.files) made.files += '\n' + file.path + ' ' + to_hex(file.hash);
    return made;
}

MadeFrom made_from(const Job& job, const Registry& registry, LoadedScene& scene) {
    MadeFrom made = made_from(job);
    if (!scene.tree && !scene.built) scene.tree = tree_of(scene.data);
    if (!scene.tree) return made;
    for (const auto& [node, bytes] : scene.kept) made.run += "\n" + node + " from " + to_hex(content_hash(*bytes));
    const auto groups = lamp_groups(job.graph, registry);
    for (std::size_t i = 0; i < written_nodes(job.graph); ++i) {
        const Node& node = job.graph.nodes[i];
        const Kind& kind = *registry.find(node.kind);
        made.lamps.push_back(groups_wanted(node, groups));
        made.reads.push_back(kind.role == Role::scene ? SceneParts() : reads_of(kind, node));
    }
    made.light = text_of_light(job.graph, registry);
    FilmData film = scene.built ? scene.built->film() : scene.data.film;
    film.width = job.width, film.height = job.height;
    made.scene = scene.tree;
    made.scene->look_by(scene.built ? scene.built->seen_from() : camera_in(scene.data, job.width, job.height), film);
    return made;
}

MadeFrom made_from_if_prepared(const Job& job, const Registry& registry, LoadedScene& scene) {
    return preparing_nodes(job.graph, registry).empty() ? made_from(job) : made_from(job, registry, scene);
}

}  // namespace lightnet
