// Scene and collision check of an arm of two bars among convex polygons: separating axes, after discs around the shapes.
#pragma once

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

struct Point {
    double x, y;
};

/// A convex polygon, counter-clockwise, with the disc around it.
struct Polygon {
    std::vector<Point> corners, normals;
    /// Of each side: its normal times any of its points.
    std::vector<double> offsets;
    Point center{0, 0};
    double radius = 0;

    explicit Polygon(std::vector<Point> points) : corners(std::move(points)) {
        const size_t n = corners.size();
        for (const Point &p : corners) {
            center.x += p.x / n;
            center.y += p.y / n;
        }
        for (size_t k = 0; k < n; ++k) {
            const Point a = corners[k], b = corners[(k + 1) % n];
            normals.push_back({b.y - a.y, a.x - b.x});
            offsets.push_back(normals[k].x * a.x + normals[k].y * a.y);
            radius = std::max(radius, std::hypot(a.x - center.x, a.y - center.y));
        }
    }
};

/// Where a link is: its frame's origin, and the cosine and sine of its angle.
struct Pose {
    double x, y, cos, sin;
    Point operator()(Point p) const { return {x + cos * p.x - sin * p.y, y + sin * p.x + cos * p.y}; }
};

/// Whether no corner of `moved` (in the frame of `fixed` by way of `pose`) is behind any side of `fixed`.
inline bool a_side_separates(const Polygon &fixed, const Point *corners, size_t count) {
    for (size_t side = 0; side < fixed.normals.size(); ++side) {
        const Point n = fixed.normals[side];
        bool separates = true;
        for (size_t k = 0; k < count && separates; ++k)
            separates = n.x * corners[k].x + n.y * corners[k].y > fixed.offsets[side];
        if (separates)
            return true;
    }
    return false;
}

class Scene {
  public:
    /// Lines of `link`, `obstacle` (each followed by the corners' coordinates), `elbow`, `start` and `goal`.
    explicit Scene(const std::string &file) {
        std::ifstream in(file);
        if (!in)
            throw std::runtime_error("cannot read " + file);
        for (std::string line, what; std::getline(in, line);) {
            std::istringstream words(line);
            words >> what;
            std::vector<double> numbers;
            for (double number; words >> number;)
                numbers.push_back(number);
            if (what == "elbow")
                elbow_ = numbers.at(0);
            else if (what == "start")
                start = {numbers.at(0), numbers.at(1)};
            else if (what == "goal")
                goal = {numbers.at(0), numbers.at(1)};
            else
                (what == "link" ? links_ : obstacles_).push_back(polygon(numbers));
        }
        if (links_.size() != 2 || obstacles_.empty())
            throw std::runtime_error(file + " is not a scene with two links and obstacles");
    }

    bool collides(double q1, double q2) const {
        const double c = std::cos(q1), s = std::sin(q1);
        const Pose first{0, 0, c, s};
        const Pose second{elbow_ * c, elbow_ * s, std::cos(q1 + q2), std::sin(q1 + q2)};
        return hits(links_[0], first) || hits(links_[1], second);
    }

    std::array<double, 2> start{}, goal{};

  private:
    static Polygon polygon(const std::vector<double> &numbers) {
        std::vector<Point> corners;
        for (size_t k = 0; k + 1 < numbers.size(); k += 2)
            corners.push_back({numbers[k], numbers[k + 1]});
        return Polygon(corners);
    }

    bool hits(const Polygon &link, const Pose &pose) const {
        const Point center = pose(link.center);
        std::array<Point, 16> world{}, local{};
        bool placed = false;
        for (const Polygon &obstacle : obstacles_) {
            const double dx = center.x - obstacle.center.x, dy = center.y - obstacle.center.y;
            const double reach = link.radius + obstacle.radius;
            if (dx * dx + dy * dy > reach * reach)
                continue;
            if (!placed) {
                for (size_t k = 0; k < link.corners.size(); ++k)
                    world.at(k) = pose(link.corners[k]);
                placed = true;
            }
            if (a_side_separates(obstacle, world.data(), link.corners.size()))
                continue;
            for (size_t k = 0; k < obstacle.corners.size(); ++k) {
                const double x = obstacle.corners[k].x - pose.x, y = obstacle.corners[k].y - pose.y;
                local.at(k) = {pose.cos * x + pose.sin * y, pose.cos * y - pose.sin * x};
            }
            if (!a_side_separates(link, local.data(), obstacle.corners.size()))
                return true;
        }
        return false;
    }

    std::vector<Polygon> links_, obstacles_;
    double elbow_ = 0;
};
