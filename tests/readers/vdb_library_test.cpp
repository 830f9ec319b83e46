// What OpenVDB's own library writes is read as it was meant.
#include <gtest/gtest.h>

#if defined(LIGHTNET_HAS_OPENVDB)
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#endif

#include <cmath>
#include <span>

#include "core/readers/common/vdb_file.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/process.hpp"

namespace lightnet::test::vdb_library_test {
namespace {

#if defined(LIGHTNET_HAS_OPENVDB)
template <class Grid>
void expect_to_be_read() {
    const auto grid = Grid::create(0);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    auto writer = grid->getAccessor();
    for (int x = -20; x < 30; ++x)
        for (int y = 100; y < 120; ++y)
            for (int z = -5; z < 140; z += 3)
                writer.setValue({x, y, z}, 1 + std::sin(0.3f * float(x) + 0.7f * float(y * z)));
    grid->fill({{64, 100, 0}, {95, 139, 31}}, 0.75f);  // whole parts of nodes among them
    writer.setValueOff({-20, 100, -5}, 3.f);           // a number that is not active
    const auto map = openvdb::math::Transform::createLinearTransform(0.25);
    map->postRotate(0.4, openvdb::math::Y_AXIS);
    map->postScale({1, 2, 1});
    map->postTranslate({1, -2, 3});
    const Folder folder;
    for (const bool affine : {false, true})
        for (const bool half : {false, true})
            for (const std::uint32_t packing : {0, 1, 2, 3, 4, 6}) {
                grid->setTransform(affine ? map : openvdb::math::Transform::createLinearTransform(0.5));
                grid->setSaveFloatAsHalf(half);
                openvdb::io::File file(folder / "smoke.vdb");
                file.setCompression(packing);
                file.write(openvdb::GridPtrVec{grid});
                file.close();
                const std::string bytes = bytes_of(folder / "smoke.vdb");
                const auto found = read_vdb(std::as_bytes(std::span(bytes)), "density");
                ASSERT_TRUE(found);
                for (int x = -25; x < 100; x += 3)
                    for (int y = 95; y < 145; y += 5)
                        for (int z = -7; z < 143; z += 2) {
                            const auto at = grid->indexToWorld(openvdb::Vec3d(x, y, z));
                            const Vec3 place{float(at[0]), float(at[1]), float(at[2])};
                            const float value = found->grid->at(transform_point(found->to_grid, place)).r;
                            ASSERT_NEAR(value, grid->tree().getValue({x, y, z}), 4e-3f)
                                << x << ' ' << y << ' ' << z << " packing " << packing << " half " << half;
                        }
            }
}
#endif

TEST(VdbOfTheLibrary, IsReadAsItWasMeant) {
#ifndef LIGHTNET_HAS_OPENVDB
    GTEST_SKIP() << "OpenVDB is missing: libopenvdb-dev";
#else
    openvdb::initialize();
    expect_to_be_read<openvdb::FloatGrid>();
    expect_to_be_read<openvdb::DoubleGrid>();
#endif
}

}  // namespace
}  // namespace lightnet::test::vdb_library_test
