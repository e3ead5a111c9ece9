"""A dance that grows at its end while it is danced: joins blended, feet planted."""
