#include "core/runtime/job.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/error.hpp"

namespace lightnet {
namespace {

using ::testing::HasSubstr;

Job some_job() {
    Job job;
    job.graph.file = "box.lua";
    job.graph.nodes = {{"scene", "Scene", {Value{std::string("box.pbrt")}}, {}, {"box.lua", 1}}};
    job.scene = "box.pbrt";
    job.files = {{"box.pbrt", content_hash(std::string_view("x")), 1}};
    job.seed = ~std::uint64_t{0};
    job.isa = "avx2";
    job.width = 64, job.height = 32;
    job.rules.side_fibers = 7;
    job.checking = true;
    return job;
}

std::string error_of(const std::string& text) {
    try {
        job_from_json(text);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    return text.replace(text.find(what), what.size(), with);
}

TEST(Job, ComesBackFromItsText) { EXPECT_EQ(job_from_json(to_json(some_job())), some_job()); }

TEST(Job, HasCountsThatAreCounts) {
    for (const char* wrong : {"-1", "1e300", "0.5", "4294967296", "\"64\""})
        EXPECT_THAT(error_of(replaced(to_json(some_job()), "\"width\":64", std::string("\"width\":") + wrong)),
                    HasSubstr("'width' is no count"))
            << wrong;
}

TEST(Job, IsNotNestedWithoutEnd) {
    const std::string nest = std::string(1000000, '[') + std::string(1000000, ']');
    EXPECT_THAT(error_of("{\"graph\":" + nest + "}"), HasSubstr("nested too deeply"));
}

}  // namespace
}  // namespace lightnet
