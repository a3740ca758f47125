/* small_scene.h: a scene for tests of the program: a lamp beside a ball, and two cameras; enough for noise, cheap
 * enough for a test.
 * SPDX-License-Identifier: MIT */
#pragma once

static const char small_scene[] =
    "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"FACET_shape\"],\"scene\":0,"
    "\"scenes\":[{\"nodes\":[0,1,2,3]}],\"cameras\":["
    "{\"name\":\"front\",\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"znear\":0.1,\"aspectRatio\":2}},"
    "{\"name\":\"far\",\"type\":\"perspective\",\"perspective\":{\"yfov\":0.4,\"znear\":0.1}}],"
    "\"materials\":[{\"name\":\"ball\",\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.4}},"
    "{\"name\":\"lamp\",\"emissiveFactor\":[1,1,1]}],\"nodes\":["
    "{\"camera\":0,\"name\":\"front\",\"translation\":[0,0,5]},{\"camera\":1,\"name\":\"far\",\"translation\":[0,0,9]},"
    "{\"extensions\":{\"FACET_shape\":{\"sphere\":{\"radius\":1},\"material\":0}}},"
    "{\"translation\":[2,1,1],\"extensions\":{\"FACET_shape\":{\"sphere\":{\"radius\":0.5},\"material\":1}}}]}";
