// Runs of one planner of OMPL on the arm's torus, one after the other in this process. Prints a JSON array, an object a run.
//
// usage: ompl_peer SCENE PLANNER SEED LIMIT_SECONDS first|anytime RUNS
//
// "first" stops at the first solution, "anytime" improves it until the limit.
#include "scene.hpp"

#include <chrono>
#include <iomanip>
#include <iostream>
#include <limits>
#include <memory>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/samplers/informed/RejectionInfSampler.h>
#include <ompl/base/spaces/SO2StateSpace.h>
#include <ompl/config.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/est/BiEST.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

namespace ob = ompl::base;
namespace og = ompl::geometric;

namespace {

/// Motions are tested where no joint has moved by more than this, radians.
constexpr double RESOLUTION = 0.01;

double angle(const ob::State *state, unsigned joint) {
    return state->as<ob::CompoundState>()->as<ob::SO2StateSpace::StateType>(joint)->value;
}

/// Two circles, with the Euclidean metric (OMPL's own compound space adds the angles up).
class Torus : public ob::CompoundStateSpace {
  public:
    Torus() {
        for (int joint = 0; joint < 2; ++joint)
            addSubspace(std::make_shared<ob::SO2StateSpace>(), 1.0);
        lock();
    }
    double distance(const ob::State *a, const ob::State *b) const override {
        double squares = 0;
        for (unsigned joint = 0; joint < 2; ++joint) {
            double difference = std::abs(angle(a, joint) - angle(b, joint));
            if (difference > M_PI)
                difference = 2 * M_PI - difference;
            squares += difference * difference;
        }
        return std::sqrt(squares);
    }
    double getMaximumExtent() const override { return M_PI * std::sqrt(2.0); }
};

/// Path length; OMPL's direct sampling of the ellipse of better paths does not know circles, rejection does.
class Length : public ob::PathLengthOptimizationObjective {
  public:
    using ob::PathLengthOptimizationObjective::PathLengthOptimizationObjective;
    ob::InformedSamplerPtr allocInformedStateSampler(const ob::ProblemDefinitionPtr &problem,
                                                     unsigned calls) const override {
        return std::make_shared<ob::RejectionInfSampler>(problem, calls);
    }
};

ob::PlannerPtr planner(const std::string &name, const ob::SpaceInformationPtr &space) {
    if (name == "RRTConnect")
        return std::make_shared<og::RRTConnect>(space);
    if (name == "BiEST")
        return std::make_shared<og::BiEST>(space);
    if (name == "PRM")
        return std::make_shared<og::PRM>(space);
    if (name == "RRT*")
        return std::make_shared<og::RRTstar>(space);
    if (name == "BIT*")
        return std::make_shared<og::BITstar>(space);
    throw std::runtime_error("no planner " + name);
}

void place(ob::ScopedState<> &state, const std::array<double, 2> &angles) {
    for (unsigned joint = 0; joint < 2; ++joint)
        state->as<ob::CompoundState>()->as<ob::SO2StateSpace::StateType>(joint)->value = angles[joint];
}

void run(const Scene &scene, const std::string &name, double limit, bool first) {
    const auto space = std::make_shared<Torus>();
    og::SimpleSetup setup(space);
    setup.setStateValidityChecker(
        [&scene](const ob::State *state) { return !scene.collides(angle(state, 0), angle(state, 1)); });
    setup.getSpaceInformation()->setStateValidityCheckingResolution(RESOLUTION / M_PI);
    ob::ScopedState<> start(space), goal(space);
    place(start, scene.start);
    place(goal, scene.goal);
    setup.setStartAndGoalStates(start, goal);
    if (name == "RRT*" || name == "BIT*") {
        auto objective = std::make_shared<Length>(setup.getSpaceInformation());
        // Any cost satisfies an infinite threshold, none a threshold of zero.
        objective->setCostThreshold(ob::Cost(first ? std::numeric_limits<double>::infinity() : 0.0));
        setup.setOptimizationObjective(objective);
    }
    setup.setPlanner(planner(name, setup.getSpaceInformation()));

    const auto before = std::chrono::steady_clock::now();
    setup.setup();
    // solve(limit) would start a thread that looks at the clock now and then, and wait for it in the end.
    const ob::PlannerStatus status = setup.getPlanner()->solve(ob::timedPlannerTerminationCondition(limit));
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - before;

    std::cout << std::setprecision(17) << "{\"status\": \"" << status.asString() << "\", \"ms\": " << taken.count();
    if (status == ob::PlannerStatus::EXACT_SOLUTION) {
        const auto &states = setup.getSolutionPath().getStates();
        std::cout << ", \"path\": [";
        for (size_t k = 0; k < states.size(); ++k)
            std::cout << (k ? ", [" : "[") << angle(states[k], 0) << ", " << angle(states[k], 1) << ']';
        std::cout << ']';
    }
    std::cout << "}";
}

} // namespace

int main(int count, char **words) {
    try {
        const std::vector<std::string> arguments(words + 1, words + count);
        if (arguments.size() == 1 && arguments[0] == "version") {
            std::cout << OMPL_MAJOR_VERSION << "." << OMPL_MINOR_VERSION << "." << OMPL_PATCH_VERSION << '\n';
            return 0;
        }
        if (arguments.size() != 6)
            throw std::runtime_error("usage: ompl_peer SCENE PLANNER SEED LIMIT_SECONDS first|anytime RUNS, or version");
        ompl::msg::noOutputHandler();
        ompl::RNG::setSeed(std::stoul(arguments[2]));
        const Scene scene(arguments[0]);
        for (int index = 0, runs = std::stoi(arguments[5]); index < runs; ++index) {
            std::cout << (index ? ",\n" : "[");
            run(scene, arguments[1], std::stod(arguments[3]), arguments[4] == "first");
        }
        std::cout << "]\n";
        return 0;
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
