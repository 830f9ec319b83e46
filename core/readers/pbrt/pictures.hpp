// The image files of one pbrt scene, decoded while the reader goes on.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "core/base/thread_pool.hpp"
#include "core/readers/files/files.hpp"
#include "core/readers/images/image_file.hpp"
#include "core/readers/pbrt/sources.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// Each file and encoding is decoded once. Called from one thread.
class Pictures {
public:
    Pictures(const Sources& sources, ThreadPool& thread_pool) : sources_(sources), thread_pool_(thread_pool) {}

    /// An image that is empty until finish().
    std::shared_ptr<const Image> get(const std::string& name, const Encoding& encoding, const SourceLine& where);
    /// Waits until all images are there. Those that can't be read are mid-grey, with warnings in the order in which
    /// they came.
    void finish();
    /// Warns of pixels below black; once the scene is there.
    void warn_below_black(const SceneData& scene) const;

private:
    struct Order {
        std::string name;
        SourceLine where;
        std::shared_ptr<Image> image;                  // to be decoded
        std::shared_ptr<const Image> known = nullptr;  // instead: somebody has decoded it
        std::string problem{};                         // "": none
        std::string remark{};                          // what is strange about it; "": nothing
        bool here_only = false;                        // elsewhere it may be had
    };
    using Key = std::tuple<std::string, Encoding::Curve, float>;

    Bytes read(Order& order) const;
    Bytes expected(const std::string& path) const;
    void decode(Order& order, const Bytes& bytes, const Encoding& encoding);

    const Sources& sources_;
    ThreadPool& thread_pool_;
    std::map<Key, std::shared_ptr<const Image>> known_;
    std::vector<std::unique_ptr<Order>> orders_;  // those before `reported_` are finished
    std::size_t reported_ = 0;
    std::atomic<std::uint64_t> pixels_ = 0;  // of all images
    bool too_many_ = false;                  // and said so
};

}  // namespace lightnet::pbrt
