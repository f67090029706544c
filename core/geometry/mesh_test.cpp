// mesh_test.cpp -- validation of meshes; selection of flattened instances.
#include <doctest/doctest.h>

#include <limits>

#include "geometry/layout.h"
#include "math/error.h"

using namespace dg;

namespace {

Mesh triangle_mesh() {
    Mesh mesh;
    mesh.name = "tri";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

std::string message(const Mesh& mesh) {
    try {
        mesh.validate();
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

Mesh mesh_of_size(std::size_t triangles) {
    Mesh mesh = triangle_mesh();
    mesh.triangles = std::vector<std::array<std::uint32_t, 3>>(triangles, {0, 1, 2});
    return mesh;
}

}  // namespace

TEST_CASE("a valid mesh passes") {
    Mesh mesh = triangle_mesh();
    CHECK(message(mesh) == "");
    mesh.normals = std::vector<Vec3f>(3, {0, 0, 1});
    mesh.uv[1] = std::vector<Vec2f>(3);
    CHECK(message(mesh) == "");
    CHECK(message(Mesh{}) == "");
}

TEST_CASE("time steps are counted") {
    Mesh mesh = triangle_mesh();
    mesh.positions = std::vector<Vec3f>(9);
    mesh.steps = 3;
    CHECK(message(mesh) == "");
    mesh.normals = std::vector<Vec3f>(3, {0, 0, 1});
    CHECK(message(mesh).find("normals") != std::string::npos);
    mesh.normals = std::vector<Vec3f>(9, {0, 0, 1});
    CHECK(message(mesh) == "");
    mesh.positions = std::vector<Vec3f>(8);
    CHECK(message(mesh).find("positions") != std::string::npos);
    for (const std::uint32_t steps : {0u, 130u}) {
        mesh.steps = steps;
        CHECK(message(mesh).find("time steps") != std::string::npos);
    }
}

TEST_CASE("a bad mesh is an error that names mesh and element") {
    Mesh mesh = triangle_mesh();
    mesh.positions = {{0, 0, 0}, {1, std::numeric_limits<float>::quiet_NaN(), 0}, {0, 1, 0}};
    CHECK(message(mesh).find("mesh 'tri': positions of vertex 1: wanted finite") == 0);

    mesh = triangle_mesh();
    mesh.triangles = {{0, 1, 3}};
    CHECK(message(mesh) ==
          "mesh 'tri': vertex index of triangle 0: wanted less than 3, got 3");

    mesh = triangle_mesh();
    mesh.uv[1] = std::vector<Vec2f>(2);
    CHECK(
        message(mesh) ==
        "mesh 'tri': length of texture coordinates 1: wanted 3 (one per vertex), got 2");

    mesh = triangle_mesh();
    const std::array<float, 4> blinding{1, 1, 1, std::numeric_limits<float>::infinity()};
    mesh.colors = {blinding, blinding, blinding};
    CHECK(message(mesh).find("colours of vertex 0") != std::string::npos);
}

TEST_CASE("meshes used once are flattened, shared ones while the total stays small") {
    const std::vector<Mesh> meshes{mesh_of_size(1000), mesh_of_size(10),
                                   mesh_of_size(30)};
    const std::vector<InstanceGeometry> instances{
        {0, {}, false}, {1, {}, false}, {1, {}, false}, {2, {}, false}, {2, {}, false}};
    CHECK(choose_flattened(meshes, instances, 0) ==
          std::vector{true, false, false, false, false});
    CHECK(choose_flattened(meshes, instances, 79) ==
          std::vector{true, false, false, false, false});
    CHECK(choose_flattened(meshes, instances, 80) == std::vector<bool>(5, true));
    CHECK(choose_flattened(meshes, instances) == std::vector<bool>(5, true));
    CHECK(count_flattened(meshes, instances, {true, false, false, false, true}) == 1030);
}

TEST_CASE("a large mesh is copied for no transform") {
    const std::vector<Mesh> meshes{mesh_of_size(kCompactLimit + 1), mesh_of_size(kCompactLimit)};
    Affine3f moved;
    moved.origin.y = 1;
    CHECK(choose_flattened(meshes, {{0, {}, false}, {1, moved, false}}) ==
          std::vector{true, true});
    CHECK(choose_flattened(meshes, {{0, moved, false}, {1, moved, false}}) ==
          std::vector{false, true});
}
