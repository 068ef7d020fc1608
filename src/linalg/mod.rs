//! Small numerical tools: 3×3 decompositions, rigid fits, sparse solves.
