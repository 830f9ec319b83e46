#include "transport/arrival.hpp"

#include "core/error.hpp"
#include "core/graph/check.hpp"

namespace lightnet {

Arrival read_arrival(const std::string& job, const std::string& plan, const Registry& registry) {
    for (const auto* text : {&job, &plan})
        if (text->size() > most_job_bytes)
            throw Error("a job of " + std::to_string(text->size()) + " bytes is larger than any that is taken (" +
                        std::to_string(most_job_bytes) + ")");
    Arrival arrival{job_from_json(job), plan_from_json(plan)};
    check(arrival.job.graph, registry);
    if (!fits(arrival.plan, arrival.job.graph)) throw Error("the plan does not fit the graph");
    return arrival;
}

}  // namespace lightnet
