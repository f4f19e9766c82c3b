// Distances in a cell of two arms with two revolute joints each, for Python by way of ctypes.
//
// Shapes are convex polygons with a radius around them; a disc is a polygon with one corner. Each shape belongs to a frame:
// 0 is the cell, 1 and 2 are the links of the first arm, 3 and 4 those of the second arm.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace {

struct Point {
    double x, y;
};

/// Where a frame is: its origin, and the cosine and sine of its angle.
struct Pose {
    double x, y, cos, sin;
    Point operator()(Point p) const { return {x + cos * p.x - sin * p.y, y + sin * p.x + cos * p.y}; }
};

struct Shape {
    int frame;
    double radius;
    std::vector<Point> corners;
    /// Disc around the shape, with its radius.
    Point center;
    double reach;
};

/// The place of joint 1 and the direction of its zero, and the place of joint 2 in the frame of link 1.
struct Arm {
    double x, y, angle, elbow_x, elbow_y;
};

struct Pair {
    int a, b, between_arms;
};

using Corners = std::vector<Point>;

/// Whether a side of `a` has all corners of `b` beyond it. Corners are counter-clockwise.
bool side_separates(const Corners &a, const Corners &b) {
    for (size_t k = 0; a.size() > 2 && k < a.size(); ++k) {
        const Point p = a[k], q = a[(k + 1) % a.size()];
        const double nx = q.y - p.y, ny = p.x - q.x;
        if (std::all_of(b.begin(), b.end(), [&](Point c) { return nx * (c.x - p.x) + ny * (c.y - p.y) > 0; }))
            return true;
    }
    return false;
}

/// Least distance of the corners of `b` from the sides of `a`.
double corners_to_sides(const Corners &a, const Corners &b) {
    double least = HUGE_VAL;
    for (size_t k = 0; k < a.size(); ++k) {
        const Point p = a[k], q = a[(k + 1) % a.size()];
        const double dx = q.x - p.x, dy = q.y - p.y, square = dx * dx + dy * dy;
        for (const Point c : b) {
            const double along = ((c.x - p.x) * dx + (c.y - p.y) * dy) / square;
            const double t = square > 0 ? std::clamp(along, 0.0, 1.0) : 0;
            least = std::min(least, std::hypot(c.x - p.x - t * dx, c.y - p.y - t * dy));
        }
    }
    return least;
}

/// Distance of two convex polygons, zero if they overlap.
double distance(const Corners &a, const Corners &b) {
    const bool is_apart = (a.size() == 1 && b.size() == 1) || side_separates(a, b) || side_separates(b, a);
    return is_apart ? std::min(corners_to_sides(a, b), corners_to_sides(b, a)) : 0;
}

class Cell {
  public:
    std::array<Arm, 2> arms;
    std::vector<Shape> shapes;

    /// Adds a pair of shapes that must not touch, except shapes of one arm that touch with all joints at zero.
    void add_pair(const Pair &pair) {
        place(std::array<double, 4>{}.data());
        if (pair.between_arms || gap(pair) > 0)
            pairs_.push_back(pair);
    }

    /// Whether no pair touches.
    bool is_free(const double *q) {
        place(q);
        return std::none_of(pairs_.begin(), pairs_.end(), [&](const Pair &pair) {
            return !discs_are_apart(pair, 0) && gap(pair) <= 0;
        });
    }

    /// Distance of the arms from each other, metres.
    double distance_between(const double *q) {
        place(q);
        double least = HUGE_VAL;
        for (const Pair &pair : pairs_)
            if (pair.between_arms && !discs_are_apart(pair, least))
                least = std::min(least, std::max(gap(pair), 0.0));
        return least;
    }

  private:
    std::vector<Pair> pairs_;
    std::array<Pose, 5> poses_;
    std::vector<Corners> placed_;
    std::vector<bool> is_placed_;

    void place(const double *q) {
        poses_[0] = {0, 0, 1, 0};
        for (int k = 0; k < 2; ++k) {
            const Arm &arm = arms[k];
            const double first = arm.angle + q[2 * k], second = first + q[2 * k + 1];
            const Pose link{arm.x, arm.y, std::cos(first), std::sin(first)};
            const Point elbow = link({arm.elbow_x, arm.elbow_y});
            poses_[2 * k + 1] = link;
            poses_[2 * k + 2] = {elbow.x, elbow.y, std::cos(second), std::sin(second)};
        }
        placed_.resize(shapes.size());
        is_placed_.assign(shapes.size(), false);
    }

    bool discs_are_apart(const Pair &pair, double by) const {
        const Shape &a = shapes[pair.a], &b = shapes[pair.b];
        const Point p = poses_[a.frame](a.center), r = poses_[b.frame](b.center);
        return std::hypot(p.x - r.x, p.y - r.y) > a.reach + b.reach + by;
    }

    const Corners &corners(int shape) {
        if (!is_placed_[shape]) {
            placed_[shape].clear();
            for (const Point corner : shapes[shape].corners)
                placed_[shape].push_back(poses_[shapes[shape].frame](corner));
            is_placed_[shape] = true;
        }
        return placed_[shape];
    }

    /// Distance of a pair, not positive if it overlaps.
    double gap(const Pair &pair) {
        return distance(corners(pair.a), corners(pair.b)) - shapes[pair.a].radius - shapes[pair.b].radius;
    }
};

} // namespace

extern "C" {
Cell *cell_new(const double *arms) {
    auto *cell = new Cell;
    for (int k = 0; k < 2; ++k)
        cell->arms[k] = {arms[5 * k], arms[5 * k + 1], arms[5 * k + 2], arms[5 * k + 3], arms[5 * k + 4]};
    return cell;
}

void cell_delete(Cell *cell) { delete cell; }

void cell_add_shape(Cell *cell, int frame, double radius, int count, const double *corners) {
    Shape shape{frame, radius, {}, {0, 0}, 0};
    for (int k = 0; k < count; ++k) {
        shape.corners.push_back({corners[2 * k], corners[2 * k + 1]});
        shape.center.x += corners[2 * k] / count;
        shape.center.y += corners[2 * k + 1] / count;
    }
    for (const Point corner : shape.corners)
        shape.reach = std::max(shape.reach, std::hypot(corner.x - shape.center.x, corner.y - shape.center.y) + radius);
    cell->shapes.push_back(shape);
}

void cell_add_pair(Cell *cell, int a, int b, int between_arms) { cell->add_pair({a, b, between_arms}); }

/// Number of the first of `count` configurations that collides, or -1.
int cell_first_collision(Cell *cell, int count, const double *q) {
    for (int k = 0; k < count; ++k)
        if (!cell->is_free(q + 4 * k))
            return k;
    return -1;
}

/// Whether the straight motion is free at all its samples, at most `step` apart in the space of the four joints. The start
/// is not tested.
int cell_is_motion_free(Cell *cell, const double *a, const double *b, double step) {
    double square = 0;
    for (int k = 0; k < 4; ++k)
        square += (b[k] - a[k]) * (b[k] - a[k]);
    const int count = std::max(1, int(std::ceil(std::sqrt(square) / step)));
    const auto is_free_at = [&](int n) {
        std::array<double, 4> q;
        for (int k = 0; k < 4; ++k)
            q[k] = a[k] + (b[k] - a[k]) * n / count;
        return cell->is_free(q.data());
    };
    int stride = 1;
    while (stride < count)
        stride *= 2;
    if (!is_free_at(count))
        return false;
    // The middle, then the quarters, and so on: this finds collisions early.
    for (stride /= 2; stride > 0; stride /= 2)
        for (int n = stride; n < count; n += 2 * stride)
            if (!is_free_at(n))
                return false;
    return true;
}

double cell_distance_between(Cell *cell, const double *q) { return cell->distance_between(q); }
}
