"""Named arrays out of files of others, read without ever executing anything in them."""
