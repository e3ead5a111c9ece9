"""Bodies that dance live: how they stand, how they rest, and how channels become poses."""
