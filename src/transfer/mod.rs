//! One mesh made to move like another.
