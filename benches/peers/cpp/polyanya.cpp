// Runs the code of Polyanya's authors on a mesh and a scenario of movingai.com. Prints the time of each query in
// microseconds, and the length of its path. The time is that of locating both places and of the search.
#include "mesh.h"
#include "scenario.h"
#include "searchinstance.h"

#include <chrono>
#include <cstdio>
#include <fstream>

int main(int argc, char **argv) {
    std::ifstream mesh_file(argc == 3 ? argv[1] : ""), scenario_file(argc == 3 ? argv[2] : "");
    std::vector<polyanya::Scenario> queries;
    if (!mesh_file || !scenario_file || !polyanya::load_scenarios(scenario_file, queries)) {
        std::fputs("usage: polyanya MESH SCENARIO\n", stderr);
        return 1;
    }
    polyanya::Mesh mesh(mesh_file);
    polyanya::SearchInstance search(&mesh);
    for (const polyanya::Scenario &query : queries) {
        const auto begin = std::chrono::steady_clock::now();
        search.set_start_goal(query.start, query.goal);
        search.search();
        const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
        std::printf("%.3f %.17g\n", took.count(), search.get_cost());
    }
}
