// The irradiance that photons bring, known beforehand at some of them.
#include <algorithm>
#include <memory>
#include <vector>

#include "core/base/math/sampling.hpp"
#include "core/estimate/even_scattering.hpp"
#include "core/estimate/photon_tree.hpp"
#include "core/estimate/shooting.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/services.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {
namespace {

/// Christensen 1999, "Faster photon map global illumination": takes the photons of a map, computes the irradiance at
/// some of them, and answers with that of the nearest one. Made for final gathering over a map: a lookup costs one
/// photon instead of some dozens. As blurred as the map is, in steps, and scattered as if light arrived evenly.
class PhotonIrradiance final : public LightOp {
public:
    explicit PhotonIrradiance(const NodeContext& here)
        : scene_(here.scene()),
          map_(here.taken("of")),
          key_(here.key()),
          every_(static_cast<std::size_t>(here.integer("every"))),
          gather_(static_cast<std::size_t>(here.integer("gather"))),
          radius_(gather_radius(here)) {}

    void prepare(Services& services) override {
        const auto photons = map_.frozen().as<PhotonTree>();
        if (!photons) return;
        // Those at which the irradiance is computed are no part of it: else it were too high where photons lie. They
        // are drawn by lot, as neighbours in the tree are neighbours in space.
        std::vector<std::size_t> chosen;
        for (std::size_t i = 0; i < photons->size(); ++i)
            if (is_chosen(i)) chosen.push_back(i);
        const auto others = services.once<PhotonTree>([&](Builders& builders) {
            std::vector<Photon> rest;
            for (std::size_t i = 0; i < photons->size(); ++i)
                if (!is_chosen(i)) rest.push_back((*photons)[i]);
            return PhotonTree(rest, builders);
        });
        const std::size_t count = chosen.size();
        const auto records = services.map<Photon>(
            (count + records_per_shard - 1) / records_per_shard, [&](std::size_t shard, std::vector<Photon>& out) {
                const std::size_t first = shard * records_per_shard;
                Nearest scratch;
                for (std::size_t i = first; i < std::min(count, first + records_per_shard); ++i)
                    out.push_back(record_at((*photons)[chosen[i]], *others, scratch));
            });
        records_ = services.once<PhotonTree>([&](Builders& builders) { return PhotonTree(records.all(), builders); });
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        if (!records_) return;  // others rehearse
        Nearest scratch;
        for (std::size_t i = 0; i < questions.size(); ++i) {
            const Query& question = questions[i];
            const SurfacePoint point = scene_.surface(question);
            const Bsdf bsdf = scene_.bsdf(point);
            const PhotonWindow when = window_of(scene_, question, photon_window);
            for (const Vec3& side : {point.normal, -point.normal}) {
                const Rgb scattered = evenly_scattered(bsdf, question.outgoing, side, question.lobes);
                if (!is_black(scattered))
                    answers[i] += scattered * irradiance({point.position, side, radius_, candidates, when}, scratch);
            }
        }
    }

private:
    bool is_chosen(std::size_t photon) const { return child(key_, photon) % every_ == 0; }

    /// Where a photon lies, on the side that it came from; its flux stands for irradiance. `others` bring the light of
    /// all.
    Photon record_at(const Photon& at, const PhotonTree& others, Nearest& scratch) const {
        Vec3 normal = at.normal();
        if (dot(normal, at.towards_light()) < 0) normal = -normal;
        const bool moves = scene_.moves();
        const PhotonWindow when = moves ? window_of(at.time(), photon_window) : PhotonWindow{};
        const auto found = others.find({at.position, normal, radius_, gather_, when}, scratch);
        const bool all = gather_ && found.size() == gather_;
        const float r2 = all ? found.back().distance2 : radius_ * radius_;
        Rgb sum;
        for (const auto& near : found) {
            const Photon photon = others[near.index];
            if (dot(photon.towards_light(), normal) > 0) sum += photon.flux * (1 - near.distance2 / r2);
        }
        const float share = float(every_) / float(every_ - 1);
        Photon record(at.position, r2 > 0 ? sum * (share * 2 / (pi * r2) / when.part()) : Rgb{}, normal, normal);
        if (moves) record.put_time(at.time());
        return record;
    }

    Rgb irradiance(const PhotonTree::Wanted& wanted, Nearest& scratch) const {
        for (const auto& near : records_->find(wanted, scratch)) {
            const Photon record = (*records_)[near.index];
            if (dot(record.towards_light(), wanted.normal) > 0) return record.flux;
        }
        return {};
    }

    static constexpr std::size_t records_per_shard = 4096;
    static constexpr std::size_t candidates = 4;  // the nearest may lie on the other side of a sheet

    const Scene& scene_;
    const LightOp& map_;
    Key key_;
    std::size_t every_, gather_;
    float radius_;  // m
    std::shared_ptr<const PhotonTree> records_;
};

std::vector<Param> photon_irradiance_params() {
    return {
        {.name = "of", .type = ParamType::node, .help = "the map", .choices = {"photons"}},
        {.name = "every",
         .type = ParamType::integer,
         .help = "of so many photons, one has the irradiance around it computed",
         .unit = "photons",
         .initial = Value{4.0},
         .least = 2,
         .most = 65536},
        {.name = "gather",
         .type = ParamType::integer,
         .help = "how many of the nearest photons that takes; 0: all within the radius",
         .unit = "photons",
         .initial = Value{60.0},
         .least = 0,
         .most = 65536},
        gather_radius("how far they may be away, and how far the irradiance counts"),
    };
}

}  // namespace

Kind photon_irradiance_kind() {
    return {
        .name = "PhotonIrradiance",
        .help = "the light of a photon map, as irradiance computed beforehand at some photons: a quick approximation",
        .params = photon_irradiance_params(),
        .light = {.converts = true},
        .run = {.prepares = true},
        .reads = reading(ScenePart::geometry | ScenePart::materials | ScenePart::lamps),
        .make_light = [](const NodeContext& here) { return std::make_unique<PhotonIrradiance>(here); },
    };
}

}  // namespace lightnet
