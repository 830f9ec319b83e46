// What NanoVDB's own library writes is read as it was meant.
#include <gtest/gtest.h>

#if __has_include(<nanovdb/util/GridBuilder.h>)
#define NANOVDB_USE_ZIP
#define NANOVDB_USE_BLOSC
#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/IO.h>
#define LIGHTNET_HAS_NANOVDB
#endif

#include <cmath>
#include <span>
#include <sstream>

#include "core/readers/common/nanovdb_file.hpp"

namespace lightnet::test::nanovdb_library_test {
namespace {

TEST(NanovdbOfTheLibrary, IsReadAsItWasMeant) {
#ifndef LIGHTNET_HAS_NANOVDB
    GTEST_SKIP() << "NanoVDB's headers are missing: libnanovdb-dev";
#else
    using Builder = nanovdb::GridBuilder<float>;
    Builder builder(0.0f, nanovdb::GridClass::FogVolume);
    const auto value = [](int x, int y, int z) { return 1 + std::sin(0.3f * float(x) + 0.7f * float(y * z)); };
    auto writer = builder.getAccessor();
    for (int x = -20; x < 30; ++x)
        for (int y = 100; y < 120; ++y)
            for (int z = -5; z < 140; z += 3) writer.setValue(nanovdb::Coord(x, y, z), value(x, y, z));
    const auto handle = builder.getHandle<>(0.25, nanovdb::Vec3d(1, -2, 3), "density");
    for (const auto codec : {nanovdb::io::Codec::NONE, nanovdb::io::Codec::ZIP, nanovdb::io::Codec::BLOSC}) {
        std::stringstream stream(std::string(16 + 176 + 8, '\0'));  // it leaves room for heads before it writes them
        nanovdb::io::writeGrid(stream, handle, codec);
        const std::string bytes = stream.str();
        const auto grid = read_nanovdb(std::as_bytes(std::span(bytes)), "density");
        ASSERT_TRUE(grid);
        const auto* theirs = handle.grid<float>();
        for (int x = -25; x < 35; x += 3)
            for (int y = 95; y < 125; y += 2)
                for (int z = -7; z < 143; ++z) {
                    const auto at = theirs->indexToWorld(nanovdb::Vec3d(x, y, z));
                    const Vec3 place{float(at[0]), float(at[1]), float(at[2])};
                    const float found = grid->grid->at(transform_point(grid->to_grid, place)).r;
                    ASSERT_NEAR(found, theirs->tree().getValue(nanovdb::Coord(x, y, z)), 2e-3f) << x << ' ' << y;
                }
    }
#endif
}

}  // namespace
}  // namespace lightnet::test::nanovdb_library_test
