// Files of OpenVDB: what is read of them, and what is not believed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <span>

#include "core/base/error.hpp"
#include "core/readers/common/nanovdb_file.hpp"
#include "core/readers/common/vdb_file.hpp"
#include "tests/support/vdb_bytes.hpp"

namespace lightnet::test::vdb_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

NanovdbPoints points_of_smoke() {
    NanovdbPoints grid;
    grid.step = 0.5, grid.origin = {1, 2, 3};
    grid.points = {{{0, 0, 0}, 1}, {{1, 0, 0}, 3},    {{-1, 5, 7}, 0.5f},
                   {{7, 7, 7}, 2}, {{8, -9, 100}, 4}, {{-130, 3, 20}, 5}};
    return grid;
}

SparseGrid read(const std::string& bytes, const std::string& name = "density") {
    return read_vdb(std::as_bytes(std::span(bytes)), name).value();
}

std::string error_of(const std::string& bytes) {
    try {
        read_vdb(std::as_bytes(std::span(bytes)), "density");
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

// All of these numbers are half floats.
TEST(Vdb, IsTheGridThatNanovdbHas) {
    const auto points = points_of_smoke();
    const std::string sparse = nanovdb_file({points});
    const auto expected = read_nanovdb(std::as_bytes(std::span(sparse)), "density").value();
    for (const std::uint32_t packing : {0, 1, 2, 3, 4, 6})
        for (const bool half : {false, true}) {
            const auto found = read(vdb_file({points}, {packing, half}));
            EXPECT_EQ(found.grid->content(), expected.grid->content()) << packing << ' ' << half;
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 0; j < 4; ++j) EXPECT_EQ(found.to_grid.m[i][j], expected.to_grid.m[i][j]);
        }
}

TEST(Vdb, HasTheNumbersOfAllOfItsGrids) {
    auto first = points_of_smoke(), second = points_of_smoke();
    second.name = "temperature", second.points = {{{0, 0, 0}, 600}};
    const std::string file = vdb_file({first, second}), other = nanovdb_file({first});
    EXPECT_TRUE(is_vdb(std::as_bytes(std::span(file))));
    EXPECT_FALSE(is_vdb(std::as_bytes(std::span(other))));
    EXPECT_THAT(names_in_vdb(std::as_bytes(std::span(file))), ElementsAre("density", "temperature"));
    const auto heat = read(file, "temperature");
    EXPECT_NEAR(heat.grid->at(transform_point(heat.to_grid, {1, 2, 3})).r, 600, 0.1f);
    EXPECT_FALSE(read_vdb(std::as_bytes(std::span(file)), "heat"));
}

TEST(Vdb, IsRefusedWithTheReasonWhereItIsOfAnotherKind) {
    const auto points = points_of_smoke();
    const std::string good = vdb_file({points});
    const auto changed = [&](const std::function<void(std::string&)>& change) {
        std::string bytes = good;
        change(bytes);
        return error_of(bytes);
    };
    EXPECT_EQ(error_of(good), "");
    EXPECT_THAT(error_of(""), HasSubstr("it ends early"));
    EXPECT_THAT(error_of("nothing of that kind"), HasSubstr("does not begin as an OpenVDB file does"));
    EXPECT_THAT(changed([](auto& b) { b[8] = char(220); }), HasSubstr("version 220 of OpenVDB's format is not known"));
    EXPECT_THAT(changed([](auto& b) { b[20] = 0; }), HasSubstr("written to a stream"));
    EXPECT_THAT(error_of(vdb_file({points}, {0, false, "NonlinearFrustumMap"})), HasSubstr("is not affine"));
    EXPECT_THAT(error_of(vdb_file({points}, {0, false, "UniformScaleTranslateMap", "Tree_vec3s_5_4_3"})),
                HasSubstr("grid 'density' is of type 'Tree_vec3s_5_4_3', neither float nor double"));
    EXPECT_THAT(error_of(vdb_file({points}, {0, false, "UniformScaleTranslateMap", "Tree_float_5_4_3", "level set"})),
                HasSubstr("grid 'density' is not a fog volume"));
    const std::size_t first = 8 + 4 + 8 + 1 + 36 + 4;  // where it says how many grids there are
    EXPECT_THAT(changed([&](auto& b) {
                    std::memset(&b[first], 0xff, 4);
                    const std::uint64_t again = first + 4;
                    std::memcpy(&b[first + 4 + 4 + 7 + 4 + 16 + 4 + 16], &again, 8);
                }),
                HasSubstr("a grid ends before it begins"));
    NanovdbPoints still = points;
    still.step = 0;
    EXPECT_THAT(error_of(vdb_file({still})), HasSubstr("transform"));
    NanovdbPoints infinite;
    infinite.points = {{{0, 0, 0}, INFINITY}};
    EXPECT_THAT(error_of(vdb_file({infinite})), HasSubstr("a number is not finite"));
    NanovdbPoints far;
    far.points = {{{0, 0, 0}, 1}, {{1 << 29, 1 << 29, 1 << 29}, 1}};
    EXPECT_THAT(error_of(vdb_file({far}, {2})), HasSubstr("which is more than can be held"));
}

TEST(Vdb, IsRefusedWhereItEndsEarly) {
    for (const std::uint32_t packing : {0, 3, 6}) {
        const std::string good = vdb_file({points_of_smoke()}, {packing});
        for (std::size_t size = 0; size < good.size(); size += 1 + size / 3)
            EXPECT_NE(error_of(good.substr(0, size)), "") << size;
        EXPECT_NE(error_of(good.substr(0, good.size() - 1)), "");
    }
}

// Parts of nodes that have one number each, and what is not active but not 0 either.
TEST(Vdb, HasPartsOfOneNumber) {
    NanovdbPoints one;
    one.points = {{{0, 0, 0}, 1}};
    std::string file = vdb_file({one}, {2});
    const std::string head = file.substr(0, file.size() - 512 / 8 - 1 - 4);  // but for the leaf's numbers
    const std::size_t leaf = head.size() - 64, lower = leaf - 1 - 2 * 512;
    std::string parts = file;
    const std::uint32_t tile = 3;  // 8 points wide, from (0, 0, 24) on
    parts[lower + 512] = char(1u << tile);
    parts.insert(leaf, std::string("\0\0\x20\x40", 4));  // 2.5
    // four bytes more in front of the leaves' numbers and of the end
    const std::size_t offsets = parts.find(std::string("Tree_float_5_4_3")) + 16 + 4;
    for (const std::size_t at : {offsets + 8, offsets + 16}) {
        std::uint64_t value = 0;
        std::memcpy(&value, &parts[at], 8);
        value += 4;
        std::memcpy(&parts[at], &value, 8);
    }
    const auto found = read(parts);
    const auto at = [&](float z) { return found.grid->at(transform_point(found.to_grid, {4, 4, z})).r; };
    EXPECT_NEAR(at(28), 2.5f, 1e-5f);
    EXPECT_EQ(at(20), 0);
    EXPECT_NEAR(found.grid->at(transform_point(found.to_grid, {0, 0, 0})).r, 1, 1e-4f);
}

}  // namespace
}  // namespace lightnet::test::vdb_test
