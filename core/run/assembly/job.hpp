// A job: all that a host must know to take part in a run, and nothing of who else does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/hash.hpp"
#include "core/network/graph/graph.hpp"
#include "core/readers/files/files.hpp"
#include "core/run/assembly/assembly.hpp"
#include "core/run/assembly/load_scene.hpp"
#include "core/run/assembly/prepared.hpp"
#include "core/run/message/tuning.hpp"

namespace lightnet {

/// A file of the scene, by the name under which the scene asks for it.
struct JobFile {
    std::string path;
    Hash hash;
    std::uint64_t size = 0;  // bytes
    friend bool operator==(const JobFile&, const JobFile&) = default;
};

/// A value: goes to hosts as text.
struct Job {
    Graph graph;                 // checked
    std::string scene;           // path of the scene file
    std::vector<JobFile> files;  // that reading the scene opens
    std::uint64_t seed = 0;
    std::string isa;                      // of Embree
    std::uint32_t width = 0, height = 0;  // of the picture, pixels
    Tuning tuning;                        // what places must know of it travels
    std::vector<std::string> plugins;     // that the graph needs: see plugins_of()
    friend bool operator==(const Job&, const Job&) = default;
};

/// A job's text is no longer than this: what is longer need not even be taken in.
inline constexpr std::size_t most_job_bytes = std::size_t{32} << 20;

std::string to_json(const Job& job);
/// Throws Error on anything but a job.
Job job_from_json(std::string_view text);
/// A job from elsewhere, with all that has to be looked at before it can be trusted: the graph is sound, as check() has
/// it. Throws Error that says what is wrong. Takes up to some seconds for a text that means ill; touches nothing but
/// what it is given, so any thread may call it.
Job read_job(std::string_view text, const Registry& registry);

/// Reads the scene, changes what the graph overrides, and builds everything that the places of a process share.
std::shared_ptr<const Network> build_network(const Job& job, const Registry& registry, Files& files,
                                             std::function<Bytes(const Hash&)> results = {});
/// Builds what the places of a process share from a scene that has been loaded, or around the one that it brings built.
std::shared_ptr<const Network> build_network(const Job& job, const Registry& registry, LoadedScene scene,
                                             std::function<Bytes(const Hash&)> results = {});

/// What the scene of a job is built from: where this is the same, so is the scene.
struct SceneSource {
    std::string graph, scene;             // paths of their files
    std::vector<JobFile> files;           // by their content
    std::vector<Value> entries;           // of the Scene node
    std::map<std::string, Value> params;  // of the scene itself
    std::map<std::string, Value> sight;   // of who looks at it
    std::map<std::string, Value> edits;   // of its lamps and materials
    std::string isa;
    std::uint32_t width = 0, height = 0;
    friend bool operator==(const SceneSource&, const SceneSource&) = default;
    /// Is it the same, whoever looks at it?
    bool is_but_for_sight(const SceneSource& other) const;
    /// Is it that, but for edits of lamps and materials as well?
    bool is_but_for_edits(const SceneSource& other) const;
};
SceneSource scene_source(const Job& job, const Registry& registry);
/// A network around a scene that was built for a job with the same source. Its nodes must not go on from kept results,
/// which ask for the scene as it was read. Throws UserError with what nodes find wrong with the scene.
std::shared_ptr<const Network> build_network(const Job& job, const Registry& registry,
                                             std::shared_ptr<const Scene> built,
                                             std::function<Bytes(const Hash&)> results);

/// A scene that was built for a job with the same source but for the camera, as this job looks at it; it shares all
/// else. Null: it can't be, as more hangs on the camera. Throws UserError when that camera can't be.
std::shared_ptr<const Scene> seen_by(const Job& job, const Registry& registry, const Scene& built);

/// Likewise where the job edits lamps and materials in another way. Null as well where anything moves. It has data of
/// its own, and shares what finds surfaces where that does not hang on materials.
std::shared_ptr<const Scene> edited(const Job& job, const Registry& registry, const Scene& built);

/// All that what is prepared may depend on, where nobody looks into the scene.
MadeFrom made_from(const Job& job);
/// What it depends on by the parts of a scene that has been loaded. That is looked into first, unless somebody has
/// (LoadedScene::tree) or it is built already, which takes as long as reading its files once more.
MadeFrom made_from(const Job& job, const Registry& registry, LoadedScene& scene);
/// By parts of the scene where any node prepares; else made_from() of the job alone.
MadeFrom made_from_if_prepared(const Job& job, const Registry& registry, LoadedScene& scene);

}  // namespace lightnet
