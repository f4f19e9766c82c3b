// A planner of one's own: a breadth-first search over the free cells of a cspace.json. It prints waypoints as CSV.
//     c++ -std=c++17 -o own_planner own_planner.cpp && ./own_planner cspace.json > results/own/shelf.csv
#include <cctype>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <queue>
#include <string>
#include <vector>

// Returns the numbers of the array behind the last occurrence of a key.
std::vector<double> numbers(const std::string& text, const std::string& key) {
    std::vector<double> found;
    const char* at = text.c_str() + text.rfind("\"" + key + "\"") + key.size() + 3;
    while (std::isspace(*at) || *at == '[' || *at == ',')
        if (char* end; std::isdigit(*++at) || *at == '-') found.push_back(std::strtod(at, &end)), at = end;
    return found;
}

// Returns the text behind `"joint": "` from a position on.
std::string joint(const std::string& text, std::size_t from) {
    const std::size_t at = text.find("\"joint\": \"", from) + 10;
    return text.substr(at, text.find('"', at) - at);
}

int main(int, char** arguments) {
    std::ifstream file(arguments[1]);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const auto start = numbers(text, "start"), goal = numbers(text, "goals"), blocked = numbers(text, "blocked");
    const auto lower = numbers(text, "lower"), size = numbers(text, "size"), shape = numbers(text, "shape");
    const int columns = shape[1], cells = shape[0] * columns;
    const auto cell = [&](const std::vector<double>& q) {
        return int((q[0] - lower[0]) / size[0]) * columns + int((q[1] - lower[1]) / size[1]);
    };
    // The search begins at the goal, so that the next cells lead there.
    std::vector<int> next(cells, -1);
    std::queue<int> queue({cell(goal)});
    for (next[cell(goal)] = cell(goal); !queue.empty(); queue.pop()) {
        const int c = queue.front(), column = c % columns;
        const bool inside[] = {c >= columns, c + columns < cells, column > 0, column + 1 < columns};
        const int neighbors[] = {c - columns, c + columns, c - 1, c + 1};
        for (int k = 0; k < 4; ++k)
            if (inside[k] && !blocked[neighbors[k]] && next[neighbors[k]] < 0) next[neighbors[k]] = c, queue.push(neighbors[k]);
    }
    if (next[cell(start)] < 0) return std::fputs("the cells have no path\n", stderr), 1;
    const std::string first = joint(text, 0), second = joint(text, text.find("\"" + first + "\""));
    std::printf("%s,%s\n%.17g,%.17g\n", first.c_str(), second.c_str(), start[0], start[1]);
    for (int c = cell(start), before = -1; c != before; before = c, c = next[c])
        std::printf("%.17g,%.17g\n", lower[0] + (c / columns + 0.5) * size[0], lower[1] + (c % columns + 0.5) * size[1]);
    std::printf("%.17g,%.17g\n", goal[0], goal[1]);
}
