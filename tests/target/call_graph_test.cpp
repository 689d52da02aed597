#include "call_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace heatsoak::target {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::string node(const std::string& name, int bytes, const std::string& kind = "static") {
  return "node: { title: \"" + name + "\" label: \"int " + name + "()\\nx.cpp:1:2\\n" + std::to_string(bytes) + " bytes (" + kind +
         ")\" }\n";
}
std::string outside(const std::string& name) { return "node: { title: \"" + name + "\" label: \"" + name + "\" shape : ellipse }\n"; }
std::string edge(const std::string& from, const std::string& to) {
  return "edge: { sourcename: \"" + from + "\" targetname: \"" + to + "\" label: \"x.cpp:3:4\" }\n";
}

TEST(CallGraph, DeepestPathIsFoundAcrossFiles) {
  CallGraph graph;
  graph.add(node("root", 16) + node("a.cpp:wide", 100) + outside("deep") + edge("root", "a.cpp:wide") + edge("root", "deep"));
  graph.add(node("deep", 24) + node("b.cpp:leaf", 80) + edge("deep", "b.cpp:leaf"));
  const CallGraph::Depth depth = graph.depth_of("root");
  EXPECT_EQ(depth.bytes, 16U + 24U + 80U);
  EXPECT_THAT(depth.path, ElementsAre("root", "deep", "leaf"));
  EXPECT_THAT(depth.problems, IsEmpty());
}

TEST(CallGraph, SharedCalleeCountsOncePerPath) {
  CallGraph graph;
  graph.add(node("root", 8) + node("a", 8) + node("b", 16) + node("leaf", 32) + edge("root", "a") + edge("root", "b") + edge("a", "leaf") +
            edge("b", "leaf"));
  EXPECT_EQ(graph.depth_of("root").bytes, 8U + 16U + 32U);
}

TEST(CallGraph, LargestOfSeveralCopiesCounts) {
  CallGraph graph;
  graph.add(node("root", 8) + node("a.cpp:weak", 8) + edge("root", "a.cpp:weak"));
  graph.add(node("b.cpp:weak", 48));
  EXPECT_EQ(graph.depth_of("root").bytes, 56U);
}

TEST(CallGraph, WhatCannotBeBoundedIsAProblem) {
  CallGraph graph;
  graph.add(node("self", 8) + edge("self", "self"));
  graph.add(node("ping", 8) + node("pong", 8) + edge("ping", "pong") + edge("pong", "ping"));
  graph.add(node("grows", 8, "dynamic") + node("bounded", 8, "dynamic,bounded"));
  graph.add(node("calls_out", 8) + outside("printf") + edge("calls_out", "printf"));
  EXPECT_THAT(graph.depth_of("self").problems, ElementsAre("recursion: self"));
  EXPECT_THAT(graph.depth_of("ping").problems, ElementsAre("recursion: ping"));
  EXPECT_THAT(graph.depth_of("grows").problems, ElementsAre("frame without bound: grows"));
  EXPECT_THAT(graph.depth_of("bounded").problems, IsEmpty());
  EXPECT_THAT(graph.depth_of("calls_out").problems, ElementsAre("unknown function: printf"));
  EXPECT_THAT(graph.depth_of("nobody").problems, ElementsAre("unknown function: nobody"));
}

TEST(CallGraph, BoundedRecursionCountsEachTime) {
  CallGraph graph;
  graph.add(node("root", 8) + node("halves", 24) + node("leaf", 4) + edge("root", "halves") + edge("halves", "halves") +
            edge("halves", "leaf"));
  graph.bound_recursion_of("halves", 11);
  EXPECT_EQ(graph.depth_of("root").bytes, 8U + 11U * 24U + 4U);
  EXPECT_THAT(graph.depth_of("root").problems, IsEmpty());
}

TEST(CallGraph, PointersReachWhatIsDeclared) {
  CallGraph graph;
  graph.add(node("root", 8) + outside(CallGraph::kThroughPointer) + edge("root", CallGraph::kThroughPointer) + node("law", 40));
  EXPECT_THAT(graph.depth_of("root").problems, ElementsAre("call through a pointer: root"));
  graph.resolve_pointers_of("root", {"law"});
  EXPECT_EQ(graph.depth_of("root").bytes, 48U);
  EXPECT_THAT(graph.depth_of("root").problems, IsEmpty());
}

}  // namespace
}  // namespace heatsoak::target
